" Writes the syntax groups of the text in the files given as arguments to the file $OUT:
"   $MODE = all      FILE:LINE:COLUMN: CHARACTER for each character without a group
"   $MODE = groups   the words of each line with their group, WORD<tab>GROUP
set nocompatible encoding=utf-8 nomore
execute 'set runtimepath^=' . $EDITORS . '/vim'
filetype plugin on
syntax on

function! s:scan(file) abort
  execute 'edit' fnameescape(a:file)
  if &filetype !=# 'cag'
    call add(s:out, a:file . ': its type is not found')
    return
  endif
  for line in range(1, line('$'))
    let text = getline(line)
    let word = ''
    let last = ''
    let column = 1
    while column <= len(text)
      let char = matchstr(text, '\%' . column . 'c.')
      let group = synIDattr(synID(line, column, 1), 'name')
      if char =~# '\S' && group ==# '' && $MODE ==# 'all'
        call add(s:out, a:file . ':' . line . ':' . column . ': ' . char)
      endif
      if group !=# last || char !~# '\S'
        if word !=# '' && $MODE ==# 'groups' | call add(s:out, word . "\t" . last) | endif
        let word = ''
      endif
      if char =~# '\S' | let word .= char | endif
      let last = group
      let column += len(char)
    endwhile
    if word !=# '' && $MODE ==# 'groups' | call add(s:out, word . "\t" . last) | endif
  endfor
endfunction

let s:out = []
for s:file in argv()
  call s:scan(s:file)
endfor
call writefile(s:out, $OUT)
qall!
