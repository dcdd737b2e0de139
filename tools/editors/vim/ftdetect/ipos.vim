au BufRead,BufNewFile *.IPC,*.ipc setfiletype ipos
