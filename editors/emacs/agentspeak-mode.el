;;; agentspeak-mode.el --- AgentSpeak agents, their configurations and systems -*- lexical-binding: t; -*-

;; Version: 0.1.0
;; Package-Requires: ((emacs "28.1"))
;; Keywords: languages
;; SPDX-License-Identifier: MIT OR Apache-2.0

;;; Commentary:

;; Colours and comments for agents (.asl), for those .conf files that are their configurations, and for systems of
;; agents (.system).  With eglot, which is part of Emacs 29, `M-x eglot' starts the language server `asl2c lsp'.

;;; Code:

(defgroup agentspeak nil
  "AgentSpeak agents."
  :group 'languages)

(defcustom agentspeak-asl2c "asl2c"
  "The compiler, whose language server is used."
  :type 'string)

(defvar agentspeak-mode-syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?/ ". 124b" table)
    (modify-syntax-entry ?* ". 23" table)
    (modify-syntax-entry ?\n "> b" table)
    (modify-syntax-entry ?_ "_" table)
    (modify-syntax-entry ?\" "\"" table)
    table)
  "Syntax of agents and configurations.")

(defconst agentspeak-font-lock-keywords
  '(("@\\s-*\\([a-z]\\(?:\\sw\\|\\s_\\)*\\)" 1 font-lock-constant-face)
    ("\\_<\\(?:not\\|mod\\)\\_>" . font-lock-keyword-face)
    ("\\_<\\(?:true\\|false\\)\\_>" . font-lock-constant-face)
    ("\\_<\\(req\\|deadline\\|source\\|age\\)\\s-*(" 1 font-lock-preprocessor-face)
    ("\\.\\s-*\\(?:wait\\|send\\|broadcast\\|my_name\\)\\_>" . font-lock-keyword-face)
    ("<-" . font-lock-keyword-face)
    ("!\\s-*\\([a-z]\\(?:\\sw\\|\\s_\\)*\\)" 1 font-lock-type-face)
    ("[?+-]\\([a-z]\\(?:\\sw\\|\\s_\\)*\\)" 1 font-lock-variable-name-face)
    ("\\_<[A-Z]\\(?:\\sw\\|\\s_\\)*" . font-lock-variable-name-face)
    ("\\_<[a-z]\\(?:\\sw\\|\\s_\\)*" . font-lock-function-name-face))
  "Colours of agents.")

(defconst agentspeak-conf-font-lock-keywords
  `((,(concat "\\_<" (regexp-opt '("settings" "includes" "structs" "basics" "classes" "peers" "messages" "types"
                                   "settables" "perceived" "triggerables" "preemptive" "properties") t)
              "\\s-*{")
     1 font-lock-keyword-face)
    ("\\_<\\(version\\)\\s-+[0-9]" 1 font-lock-keyword-face)
    ("\\_<\\([a-z_]+\\)\\s-*=" 1 font-lock-variable-name-face)
    (,(regexp-opt '("exactly_one" "at_most_one" "at_least_one" "never" "within" "only_after" "all_handled"
                    "unless" "until") 'symbols)
     . font-lock-builtin-face)
    ("\\_<\\(all\\)\\s-+[a-zA-Z_][a-zA-Z0-9_]*\\s-+\\(but\\)\\_>" (1 font-lock-builtin-face) (2 font-lock-builtin-face))
    ("\\_<\\(tell\\|achieve\\|from\\)\\s-+[a-zA-Z_]" 1 font-lock-builtin-face)
    ("\\[\\s-*\\(source\\)\\s-*(" 1 font-lock-builtin-face)
    ("#include" . font-lock-preprocessor-face)
    ("[+-]!?\\([a-zA-Z_]\\(?:\\sw\\|\\s_\\)*\\)" 1 font-lock-type-face)
    (,(regexp-opt '("void" "bool" "int" "short" "long" "float" "double" "signed" "unsigned" "char" "const") 'symbols)
     . font-lock-type-face)
    ("\\_<[a-zA-Z_][a-zA-Z0-9_]*_t\\_>" . font-lock-type-face)
    ("\\_<\\([a-zA-Z_][a-zA-Z0-9_]*\\)\\s-*[(:]" 1 font-lock-function-name-face))
  "Colours of configurations.")

(defconst agentspeak-system-font-lock-keywords
  '(("\\_<\\(agents\\|channels\\|properties\\)\\s-*{" 1 font-lock-keyword-face)
    ("\\_<\\(version\\)\\s-+[0-9]" 1 font-lock-keyword-face)
    ("\\_<\\(capacity\\|losses\\|delay\\)\\s-*=" 1 font-lock-variable-name-face)
    ("=\\s-*\\(any\\)\\_>" 1 font-lock-constant-face)
    ("\\_<\\(?:never_together\\|within\\)\\_>" . font-lock-builtin-face)
    ("\\.[+-]!?\\([a-zA-Z_]\\(?:\\sw\\|\\s_\\)*\\)" 1 font-lock-type-face)
    ("\\_<[a-zA-Z_]\\(?:\\sw\\|\\s_\\)*\\.\\([a-zA-Z_]\\(?:\\sw\\|\\s_\\)*\\)\\s-*[,)]" 1 font-lock-function-name-face)
    ("\\_<\\([a-zA-Z_]\\(?:\\sw\\|\\s_\\)*\\)\\s-*\\(?:\\[[^]]*\\]\\)?\\s-*:" 1 font-lock-variable-name-face))
  "Colours of systems.")

;;;###autoload
(define-derived-mode agentspeak-mode prog-mode "AgentSpeak"
  "Major mode for AgentSpeak agents."
  (setq-local comment-start "// "
              comment-end ""
              indent-tabs-mode nil
              tab-width 2
              font-lock-defaults '(agentspeak-font-lock-keywords)))

;;;###autoload
(define-derived-mode agentspeak-conf-mode prog-mode "AgentSpeak-Conf"
  "Major mode for configurations of AgentSpeak agents."
  :syntax-table agentspeak-mode-syntax-table
  (setq-local comment-start "// "
              comment-end ""
              indent-tabs-mode nil
              tab-width 2
              font-lock-defaults '(agentspeak-conf-font-lock-keywords)))

;;;###autoload
(define-derived-mode agentspeak-system-mode prog-mode "AgentSpeak-System"
  "Major mode for systems of AgentSpeak agents."
  :syntax-table agentspeak-mode-syntax-table
  (setq-local comment-start "// "
              comment-end ""
              indent-tabs-mode nil
              tab-width 2
              font-lock-defaults '(agentspeak-system-font-lock-keywords)))

(defun agentspeak-configuration-p ()
  "Whether this buffer is a configuration: its section `settings' names an AgentSpeak file."
  (and buffer-file-name
       (string-suffix-p ".conf" buffer-file-name)
       (save-excursion
         (goto-char (point-min))
         (re-search-forward "\\_<settings\\s-*{[^}]*\\_<input\\s-*=\\s-*\"?[^;\"\n}]*\\.asl\\_>" nil t))))

;;;###autoload
(progn
  (add-to-list 'auto-mode-alist '("\\.asl\\'" . agentspeak-mode))
  (add-to-list 'auto-mode-alist '("\\.system\\'" . agentspeak-system-mode))
  (add-to-list 'magic-mode-alist '(agentspeak-configuration-p . agentspeak-conf-mode)))

(defvar eglot-server-programs)
(with-eval-after-load 'eglot
  (add-to-list 'eglot-server-programs
               `((agentspeak-mode agentspeak-conf-mode agentspeak-system-mode)
                 . ,(lambda (&rest _) (list agentspeak-asl2c "lsp")))))

(provide 'agentspeak-mode)
;;; agentspeak-mode.el ends here
