; Made by tools/editors/syntax.py; do not edit.
["if" "else" "for" "while" "do" "switch" "case" "default" "break" "continue" "return"] @keyword
["long" "struct" "typedef"] @type.builtin
["initial"] @keyword.modifier
["numof"] @keyword.operator
(comment) @comment
(string) @string
(header) @string
(number) @number
(directive_word) @keyword.directive
(raw_variable) @variable.builtin
(call function: (identifier) @function.call)
(function name: (identifier) @function)
(member name: (identifier) @variable.member)
((identifier) @function.builtin (#any-of? @function.builtin "_MoviLink" "_SBusCommDef" "_SBusCommOn" "_SBusCommState" "_MovCommDef" "_MovCommOn" "_Go0" "_GoAbs" "_GoRel" "_AxisStop" "_TouchProbe" "_GetSys" "_SetSys" "_Wait" "_WdOn" "_WdOff" "_SetTask" "_SetTask2" "_SetInterrupt" "_SetVarInterrupt" "_BitSet" "_BitClear" "_BitMove" "_BitMoveNeg" "_Copy" "_Memorize" "_FaultReaction" "_Reset" "_InputCall" "_SystemCall" "_Nop" "_Movilink" "_SBusComDef"))
((identifier) @type.builtin (#any-of? @type.builtin "MOVLNK" "MLDATA" "SCTRCYCL" "SCTRACYCL" "SCREC" "SSPOSSPEED" "SSPOSRAMP" "VARINT" "GSCAM" "GSCAM_EXT" "CAM_OUTPUT" "GSPODATA3" "SSPIDATA3" "GSPODATA10" "SSPIDATA10"))
