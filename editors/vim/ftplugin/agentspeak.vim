" Comments and indentation of agents.
if exists('b:did_ftplugin')
  finish
endif
let b:did_ftplugin = 1

setlocal commentstring=//\ %s comments=s1:/*,mb:*,ex:*/,:// shiftwidth=2 expandtab
" Without a language server `gq` uses the command.
if executable('asl2c')
  setlocal formatprg=asl2c\ fmt\ -
endif
let b:undo_ftplugin = 'setlocal commentstring< comments< shiftwidth< expandtab< formatprg<'
