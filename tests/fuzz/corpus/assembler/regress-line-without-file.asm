.file a.IPC
.line 2 7 17
  END
