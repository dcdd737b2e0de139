# The back end: assembler and disassembler, and the compiler proper from syntax tree to image.
ipos_layer(asm
  FOLDERS compiler/asm
  SOURCES asm/assembler.cpp asm/disassembler.cpp asm/reader.cpp asm/text_forms.cpp
  USES frontend isa image stdlib
  LIBS fmt::fmt)

file(GLOB compiler_sources CONFIGURE_DEPENDS compile.cpp sema/*.cpp codegen/*.cpp symbols/*.cpp)
ipos_layer(compiler
  FOLDERS compiler/sema compiler/codegen compiler/symbols compiler/compile.hpp
  SOURCES ${compiler_sources}
  USES frontend asm isa image stdlib
  LIBS fmt::fmt)
file(GLOB analysis_sources CONFIGURE_DEPENDS analysis/*.cpp)
ipos_layer(analysis FOLDERS compiler/analysis SOURCES ${analysis_sources} USES asm image isa stdlib LIBS fmt::fmt)
ipos_not_hot(ipos_analysis)
file(GLOB mutants_sources CONFIGURE_DEPENDS mutants/*.cpp)
ipos_layer(mutants
  FOLDERS compiler/mutants
  SOURCES ${mutants_sources}
  USES compiler isa image stdlib
  LIBS fmt::fmt)
ipos_not_hot(ipos_asm BUSY)
ipos_not_hot(ipos_compiler SIZE 20 BUSY)
ipos_join(compiler frontend asm compiler)
