" AgentSpeak agents, systems of them, and those .conf files that are their configurations.
autocmd BufNewFile,BufRead *.asl setfiletype agentspeak
autocmd BufNewFile,BufRead *.system setfiletype agentspeaksystem
autocmd BufNewFile,BufRead *.conf call s:Configuration()

" `.conf` alone says nothing: the section `settings` names an AgentSpeak file.
function! s:Configuration() abort
  let text = join(getline(1, 200), "\n")
  if text =~# '\<settings\_s*{\_[^}]*\<input\s*=\s*"\?[^;"]*\.asl\>'
    set filetype=agentspeakconf
  endif
endfunction
