" Vim with ALE as a client of `cag lsp`: run by tests/live/run.sh in a folder with the files of its tests. Writes the file type and the
" errors of a.cag to $OUT.
set nocompatible
let &runtimepath .= ',' . $EDITORS . '/vim-ale,' . $EDITORS . '/vim'
packadd! ale
filetype plugin on
let g:ale_cag_executable = $CAG
let g:ale_linters = {'cag': ['cag']}

let s:left = 100
function! Look(timer)
  let s:left -= 1
  if s:left > 0 && empty(getloclist(0))
    return
  endif
  call writefile([&filetype] + map(getloclist(0), 'v:val.lnum . ":" . v:val.col . " " . v:val.text'), $OUT)
  qall!
endfunction

function! Start() abort
  edit a.cag
  ALELint
  call timer_start(200, 'Look', {'repeat': 100})
endfunction
