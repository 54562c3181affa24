autocmd BufNewFile,BufRead *.cag setfiletype cag
