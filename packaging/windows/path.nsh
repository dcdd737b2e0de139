; A folder in the user's PATH. Texts of NSIS end after 1024 letters, and PATH may be longer: it is changed in memory of
; its own by functions of Windows, so that nothing of it is lost. Its kind (with %NAMES% or without) stays.
;
; $1 the key, $2 the kind, $3 bytes, $4 the memory, which holds ";PATH;", $5 where the folder stands in it.

!define HKCU_ 0x80000001
!define KEY_READ_WRITE 0x2001F
!define REG_EXPAND_SZ 2

; Room for as much again as the folder needs.
!macro ReadPath FOLDER
  System::Call 'advapi32::RegOpenKeyExW(p ${HKCU_}, w "Environment", i 0, i ${KEY_READ_WRITE}, *p .r1) i .r0'
  StrCpy $2 ${REG_EXPAND_SZ}
  StrCpy $3 0
  System::Call 'advapi32::RegQueryValueExW(p r1, w "Path", p 0, *i .r2, p 0, *i .r3) i .r0'
  ${If} $0 != 0
    StrCpy $2 ${REG_EXPAND_SZ}
    StrCpy $3 0
  ${EndIf}
  StrLen $5 "${FOLDER}"
  IntOp $6 $3 + $5
  IntOp $6 $6 + $5
  IntOp $6 $6 + 32
  System::Alloc $6  ; all zero
  Pop $4
  IntPtrOp $6 $4 + 2
  ${If} $3 > 0
    System::Call 'advapi32::RegQueryValueExW(p r1, w "Path", p 0, p 0, p r6, *i r3) i .r0'
  ${EndIf}
  System::Call '*$4(&i2 59)'  ; a semicolon before
  System::Call 'kernel32::lstrlenW(p r4) i .r6'
  IntOp $6 $6 - 1
  IntOp $6 $6 * 2
  IntPtrOp $6 $4 + $6
  System::Call '*$6(&i2 .r0)'
  ${If} $0 <> 59  ; and one behind
    System::Call 'kernel32::lstrcatW(p r4, w ";")'
  ${EndIf}
  System::Call 'shlwapi::StrStrIW(p r4, w ";${FOLDER};") p .r5'
!macroend

; Without the semicolons at both ends.
!macro WritePath
  System::Call 'kernel32::lstrlenW(p r4) i .r6'
  ${If} $6 > 1
    IntOp $3 $6 - 1
    IntOp $3 $3 * 2
    IntPtrOp $0 $4 + $3
    System::Call '*$0(&i2 0)'
    IntPtrOp $6 $4 + 2
    System::Call 'advapi32::RegSetValueExW(p r1, w "Path", i 0, i r2, p r6, i r3) i .r0'
  ${Else}
    System::Call 'advapi32::RegDeleteValueW(p r1, w "Path") i .r0'
  ${EndIf}
!macroend

!macro ClosePath
  System::Call 'advapi32::RegCloseKey(p r1)'
  System::Free $4
  ; consoles that are opened from now on see it
  SendMessage ${HWND_BROADCAST} ${WM_SETTINGCHANGE} 0 "STR:Environment" /TIMEOUT=5000
!macroend

!macro AddToPath FOLDER
  !insertmacro ReadPath "${FOLDER}"
  ${If} $5 = 0
    System::Call 'kernel32::lstrcatW(p r4, w "${FOLDER};")'
    !insertmacro WritePath
  ${EndIf}
  !insertmacro ClosePath
!macroend

!macro RemoveFromPath FOLDER
  !insertmacro ReadPath "${FOLDER}"
  ${If} $5 <> 0
    StrLen $6 ";${FOLDER}"
    IntOp $6 $6 * 2
    IntPtrOp $0 $5 + $6  ; what stands behind it moves to its place
    System::Call 'kernel32::lstrlenW(p r0) i .r6'
    IntOp $6 $6 + 1
    IntOp $6 $6 * 2
    System::Call 'ntdll::memmove(p r5, p r0, p r6) p ? c'
    !insertmacro WritePath
  ${EndIf}
  !insertmacro ClosePath
!macroend
