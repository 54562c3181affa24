" The language server of cag, for ALE.
call ale#Set('cag_executable', 'cag')
call ale#Set('cag_options', '')
call ale#Set('cag_settings', {})

function! ale_linters#cag#cag#Root(buffer) abort
  let l:git = ale#path#FindNearestDirectory(a:buffer, '.git')
  return empty(l:git) ? fnamemodify(bufname(a:buffer), ':p:h') : fnamemodify(l:git, ':h:h')
endfunction

call ale#linter#Define('cag', {
\   'name': 'cag',
\   'lsp': 'stdio',
\   'executable': {b -> ale#Var(b, 'cag_executable')},
\   'command': {b -> '%e lsp' . ale#Pad(ale#Var(b, 'cag_options'))},
\   'initialization_options': {b -> ale#Var(b, 'cag_settings')},
\   'project_root': function('ale_linters#cag#cag#Root'),
\})
