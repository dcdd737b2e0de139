" IPOS: sources of drive programs. Made by tools/editors/syntax.py; do not edit.
if exists("b:current_syntax")
  finish
endif
syn case match

syn keyword iposControl if else for while do switch case default break continue return
syn keyword iposType long struct typedef
syn keyword iposModifier initial
syn keyword iposWordOperator numof
syn keyword iposForeign goto sizeof int void char short unsigned signed float double enum union const static extern volatile
syn keyword iposStructure MOVLNK MLDATA SCTRCYCL SCTRACYCL SCREC SSPOSSPEED SSPOSRAMP VARINT GSCAM GSCAM_EXT CAM_OUTPUT GSPODATA3 SSPIDATA3 GSPODATA10 SSPIDATA10
syn keyword iposSystemFunction _MoviLink _SBusCommDef _SBusCommOn _SBusCommState _MovCommDef _MovCommOn _Go0 _GoAbs _GoRel _AxisStop _TouchProbe _GetSys _SetSys _Wait _WdOn _WdOff _SetTask _SetTask2 _SetInterrupt _SetVarInterrupt _BitSet _BitClear _BitMove _BitMoveNeg _Copy _Memorize _FaultReaction _Reset _InputCall _SystemCall _Nop _Movilink _SBusComDef
syn match iposVariable "\<H\d\+\>"
syn match iposNumber "\<\d\+\>"
syn match iposNumber "\<0[xX]\x\+\>"
syn match iposNumber "\<0[bB][01]\+\>"
syn match iposMember "\.\s*\h\w*"hs=s+1
syn match iposDirective "^\s*#\s*\(declare\|define\|elif\|else\|endif\|error\|if\|ifdef\|ifndef\|include\|pragma\|undef\)\>"
syn match iposIncluded "<[^>]*>" contained
syn match iposInclude "^\s*#\s*include\>.*" contains=iposDirective,iposIncluded,iposString
syn region iposString start=+"+ end=+"+ oneline
syn match iposComment "//.*$" contains=iposTodo
syn region iposComment start="/\*" end="\*/" contains=iposTodo
syn keyword iposTodo TODO FIXME contained

hi def link iposControl Statement
hi def link iposType Type
hi def link iposModifier StorageClass
hi def link iposWordOperator Operator
hi def link iposForeign Error
hi def link iposStructure Structure
hi def link iposSystemFunction Function
hi def link iposVariable Identifier
hi def link iposNumber Number
hi def link iposMember Normal
hi def link iposDirective PreProc
hi def link iposIncluded String
hi def link iposString String
hi def link iposComment Comment
hi def link iposTodo Todo

let b:current_syntax = "ipos"
