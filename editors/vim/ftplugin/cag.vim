" Settings for scripts of the cag language.
if exists('b:did_ftplugin')
  finish
endif
let b:did_ftplugin = 1
let b:undo_ftplugin = 'setlocal comments< commentstring< formatoptions< expandtab< shiftwidth< softtabstop< textwidth< makeprg< errorformat<'

setlocal comments=s1:/*,mb:*,ex:*/,:///,:// commentstring=//\ %s
setlocal formatoptions-=t formatoptions+=croql
setlocal expandtab shiftwidth=2 softtabstop=2 textwidth=100

" :make finds errors: `error: MESSAGE`, and the place on the line below.
setlocal makeprg=cag\ check\ --color\ never\ %:S
setlocal errorformat=%Eerror:\ %m,%Wwarning:\ %m,%Z%*[\ ]-->\ %f:%l:%c,%-G%.%#
