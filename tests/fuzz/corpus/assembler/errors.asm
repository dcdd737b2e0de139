REM a line with each mistake
  FLY H0
  SET H5000 = 1
  SET H0 = 99999999999
  JMP M77
M1: M1: END
  BSET H0.32 = 1
.unit nothing
.word
  WORD 0FFFFFFFF hex
