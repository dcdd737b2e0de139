; The installer of ipos for Windows, for one user, without an administrator. It puts the program into the user's folder of
; programs, its folder into the user's PATH, the program into the start menu, and makes Windows open its files. Uninstall
; takes back exactly that. packaging/windows/setup.py puts ipos.exe, LICENSE.txt and NOTICES.txt beside this and calls
;   makensis -DVERSION=1.2.3 -DOUT=setup.exe ipos.nsi
; Silently: setup.exe /S [/D=C:\folder], and uninstall.exe /S [/KEPT], which removes what the page has kept, too.
Unicode true
Target amd64-unicode
ManifestDPIAware true
ManifestSupportedOS Win10
RequestExecutionLevel user
SetCompressor /SOLID lzma
SetDateSave off

!include MUI2.nsh
!include LogicLib.nsh
!include FileFunc.nsh
!include path.nsh

!define UNINSTALL "Software\Microsoft\Windows\CurrentVersion\Uninstall\ipos"
!define CLASSES "Software\Classes"

Name "ipos ${VERSION}"
OutFile "${OUT}"
InstallDir "$LOCALAPPDATA\Programs\ipos"
InstallDirRegKey HKCU "${UNINSTALL}" InstallLocation
BrandingText " "
VIProductVersion "${VERSION}.0"
VIAddVersionKey ProductName "ipos"
VIAddVersionKey FileDescription "Installer of ipos"
VIAddVersionKey FileVersion "${VERSION}"
VIAddVersionKey ProductVersion "${VERSION}"
VIAddVersionKey LegalCopyright "the ipos contributors"

!define MUI_ICON ipos.ico
!define MUI_UNICON ipos.ico
!define MUI_COMPONENTSPAGE_SMALLDESC
!define MUI_FINISHPAGE_RUN "$INSTDIR\ipos.exe"
!define MUI_FINISHPAGE_RUN_TEXT "Open the gallery of ipos in the browser"
!insertmacro MUI_PAGE_LICENSE LICENSE.txt
!insertmacro MUI_PAGE_COMPONENTS
!insertmacro MUI_PAGE_DIRECTORY
!insertmacro MUI_PAGE_INSTFILES
!insertmacro MUI_PAGE_FINISH
!insertmacro MUI_UNPAGE_CONFIRM
!insertmacro MUI_UNPAGE_COMPONENTS
!insertmacro MUI_UNPAGE_INSTFILES
!insertmacro MUI_LANGUAGE English

; Windows opens files of this kind with ipos. `always`: the ending is ours; else ipos is one of the programs that
; "Open with" offers, and the one that opens where nobody else does.
!macro OpenFiles ENDING KIND TEXT ALWAYS
  WriteRegStr HKCU "${CLASSES}\${KIND}" "" "${TEXT}"
  WriteRegStr HKCU "${CLASSES}\${KIND}\DefaultIcon" "" "$INSTDIR\ipos.exe,0"
  WriteRegStr HKCU "${CLASSES}\${KIND}\shell\open\command" "" '"$INSTDIR\ipos.exe" serve "%1" --open'
  WriteRegStr HKCU "${CLASSES}\${ENDING}\OpenWithProgids" "${KIND}" ""
  ReadRegStr $0 HKCU "${CLASSES}\${ENDING}" ""
  ${If} $0 == ""
    ReadRegStr $0 HKLM "${CLASSES}\${ENDING}" ""
  ${EndIf}
  ${If} "${ALWAYS}" == always
  ${OrIf} $0 == ""
    WriteRegStr HKCU "${CLASSES}\${ENDING}" "" "${KIND}"
  ${EndIf}
!macroend

!macro OpenFilesNoMore ENDING KIND
  DeleteRegKey HKCU "${CLASSES}\${KIND}"
  DeleteRegValue HKCU "${CLASSES}\${ENDING}\OpenWithProgids" "${KIND}"
  ReadRegStr $0 HKCU "${CLASSES}\${ENDING}" ""
  ${If} $0 == "${KIND}"
    DeleteRegValue HKCU "${CLASSES}\${ENDING}" ""
  ${EndIf}
  DeleteRegKey /ifempty HKCU "${CLASSES}\${ENDING}\OpenWithProgids"
  DeleteRegKey /ifempty HKCU "${CLASSES}\${ENDING}"
!macroend

!define SHCNE_ASSOCCHANGED 0x08000000

Section "ipos" TheProgram
  SectionIn RO
  SetOutPath "$INSTDIR"
  File ipos.exe
  File LICENSE.txt
  File NOTICES.txt
  WriteUninstaller "$INSTDIR\uninstall.exe"
  WriteRegStr HKCU "${UNINSTALL}" DisplayName "ipos"
  WriteRegStr HKCU "${UNINSTALL}" DisplayVersion "${VERSION}"
  WriteRegStr HKCU "${UNINSTALL}" Publisher "the ipos contributors"
  WriteRegStr HKCU "${UNINSTALL}" DisplayIcon "$INSTDIR\ipos.exe,0"
  WriteRegStr HKCU "${UNINSTALL}" InstallLocation "$INSTDIR"
  WriteRegStr HKCU "${UNINSTALL}" UninstallString '"$INSTDIR\uninstall.exe"'
  WriteRegStr HKCU "${UNINSTALL}" QuietUninstallString '"$INSTDIR\uninstall.exe" /S'
  WriteRegDWORD HKCU "${UNINSTALL}" NoModify 1
  WriteRegDWORD HKCU "${UNINSTALL}" NoRepair 1
  ${GetSize} "$INSTDIR" "/S=0K" $0 $1 $2
  WriteRegDWORD HKCU "${UNINSTALL}" EstimatedSize $0
SectionEnd

Section "Start menu" StartMenu
  CreateShortcut "$SMPROGRAMS\ipos.lnk" "$INSTDIR\ipos.exe" "" "" "" "" "" "Run and test IPOSplus-style drive programs"
SectionEnd

Section "ipos in every console (PATH)" InPath
  !insertmacro AddToPath "$INSTDIR"
SectionEnd

Section "Open plants, programs and sessions" Files
  !insertmacro OpenFiles ".ipos" "ipos.session" "Session of ipos" always
  !insertmacro OpenFiles ".IPC" "ipos.program" "Program for IPOSplus-style drives" ""
  !insertmacro OpenFiles ".ipx" "ipos.image" "Compiled program of ipos" always
  !insertmacro OpenFiles ".toml" "ipos.plant" "Plant or test of ipos (TOML)" ""
  System::Call 'shell32::SHChangeNotify(i ${SHCNE_ASSOCCHANGED}, i 0, p 0, p 0)'
SectionEnd

Section "un.ipos" UnProgram
  SectionIn RO
  !insertmacro OpenFilesNoMore ".ipos" "ipos.session"
  !insertmacro OpenFilesNoMore ".IPC" "ipos.program"
  !insertmacro OpenFilesNoMore ".ipx" "ipos.image"
  !insertmacro OpenFilesNoMore ".toml" "ipos.plant"
  System::Call 'shell32::SHChangeNotify(i ${SHCNE_ASSOCCHANGED}, i 0, p 0, p 0)'
  !insertmacro RemoveFromPath "$INSTDIR"
  Delete "$SMPROGRAMS\ipos.lnk"
  DeleteRegKey HKCU "${UNINSTALL}"
  Delete "$INSTDIR\ipos.exe"
  Delete "$INSTDIR\LICENSE.txt"
  Delete "$INSTDIR\NOTICES.txt"
  Delete "$INSTDIR\uninstall.exe"
  RMDir "$INSTDIR"  ; files of somebody else keep it
SectionEnd

; Layouts of the page, lists of failed tests. Plants and sessions lie where the user put them and are never touched.
Section /o "un.What the page has kept" UnKept
  RMDir /r "$LOCALAPPDATA\ipos"
SectionEnd

Function .onInit
  SetRegView 64
FunctionEnd

Function un.onInit
  SetRegView 64
  ${GetParameters} $0
  ClearErrors
  ${GetOptions} $0 "/KEPT" $1
  ${IfNot} ${Errors}
    SectionSetFlags ${UnKept} 1
  ${EndIf}
FunctionEnd

LangString about_program ${LANG_ENGLISH} "The program with all its verbs. It needs nothing beside itself."
LangString about_menu ${LANG_ENGLISH} "An entry in the start menu that opens the gallery."
LangString about_path ${LANG_ENGLISH} "Every new console knows the command ipos."
LangString about_files ${LANG_ENGLISH} "A double click opens a session, a program or a plant in the browser. Other programs keep the files they open today."
LangString about_kept ${LANG_ENGLISH} "Layouts of the page and lists of failed tests. Plants and sessions stay where they are."
!insertmacro MUI_FUNCTION_DESCRIPTION_BEGIN
  !insertmacro MUI_DESCRIPTION_TEXT ${TheProgram} $(about_program)
  !insertmacro MUI_DESCRIPTION_TEXT ${StartMenu} $(about_menu)
  !insertmacro MUI_DESCRIPTION_TEXT ${InPath} $(about_path)
  !insertmacro MUI_DESCRIPTION_TEXT ${Files} $(about_files)
!insertmacro MUI_FUNCTION_DESCRIPTION_END
!insertmacro MUI_UNFUNCTION_DESCRIPTION_BEGIN
  !insertmacro MUI_DESCRIPTION_TEXT ${UnProgram} $(about_program)
  !insertmacro MUI_DESCRIPTION_TEXT ${UnKept} $(about_kept)
!insertmacro MUI_UNFUNCTION_DESCRIPTION_END
