# Layers: a static library that sees only the folders it owns and the folders of the layers it uses.
#
#   ipos_layer(verify FOLDERS vm/host vm/verify SOURCES verify/verify.cpp USES isa LIBS fmt::fmt)
#
# Their code goes into shared libraries, too (libipos_compile, libipos_plant); there as in a program nobody replaces a
# function of it, so the optimiser may count on what it sees.
# A layer without sources has headers only, or is a name for several layers at once.
# Every layer gets a private tree of links, <build>/layers/ipos_<name>/<folder> -> <source>/<folder>, as its only
# include root. A file that includes a folder of a layer not named in USES does not compile;
# tests/architecture tries that.

add_library(ipos_options INTERFACE)
target_compile_options(ipos_options INTERFACE -Wall -Wextra -Wconversion -Wshadow -Werror)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # g++ 12 reports overlaps inside its own std::string (GCC bug 105651).
  target_compile_options(ipos_options INTERFACE -Wno-restrict)
endif()
# An index behind the end and an empty optional are told where they happen, in the daily build and beside sanitizers.
if(IPOS_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL Debug)
  target_compile_definitions(ipos_options INTERFACE _GLIBCXX_ASSERTIONS)
endif()
if(IPOS_SANITIZE)
  target_compile_options(ipos_options INTERFACE -fsanitize=${IPOS_SANITIZE} -fno-omit-frame-pointer
                         -fno-sanitize-recover=all)
  target_link_options(ipos_options INTERFACE -fsanitize=${IPOS_SANITIZE})
  # What sanitizers write down of each check has addresses in it, a million in all. A program at a fixed place need not
  # correct them as it starts, which takes two thirds of the time then; some suites start it hundreds of times.
  target_link_options(ipos_options INTERFACE $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-no-pie>)
  find_program(IPOS_LLD ld.lld)
  if(IPOS_LLD AND CMAKE_CXX_COMPILER_ID STREQUAL Clang)  # in two thirds of the time of ld
    target_link_options(ipos_options INTERFACE -fuse-ld=lld)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # With sanitizers g++ 12 reports members of its own std::regex (GCC bug 105562), and with ThreadSanitizer copies out of
    # spans that it takes for empty.
    target_compile_options(ipos_options INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds)
  endif()
endif()
if(IPOS_FUZZ)
  # A fuzzer that sees no branches finds nothing, so all that its targets run counts them (IPOS_FUZZED). Notes of what is
  # compared find the words of a form and cost a quarter of the time of a run, so only what reads a form of bytes takes
  # them (IPOS_FUZZ_COMPARES).
  set(fuzzed $<BOOL:$<TARGET_PROPERTY:IPOS_FUZZED>>)
  set(compares $<BOOL:$<TARGET_PROPERTY:IPOS_FUZZ_COMPARES>>)
  target_compile_options(ipos_options INTERFACE $<${fuzzed}:-fsanitize=fuzzer-no-link>
                         $<$<AND:${fuzzed},$<NOT:${compares}>>:-fno-sanitize-coverage=trace-cmp>)
endif()
if(IPOS_COVERAGE)
  target_compile_options(ipos_options INTERFACE --coverage -O0)
  target_link_options(ipos_options INTERFACE --coverage)
endif()

function(ipos_for_shared_libraries target)
  if(EMSCRIPTEN)  # which has none
    return()
  endif()
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-fvisibility=hidden>)
endfunction()

# The folders are all that a target sees, with those of the targets it links.
function(ipos_see target scope)
  set(view ${PROJECT_BINARY_DIR}/layers/${target})
  foreach(folder ${ARGN})
    get_filename_component(parent ${view}/${folder} DIRECTORY)
    file(MAKE_DIRECTORY ${parent})
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${folder} ${view}/${folder} SYMBOLIC)
  endforeach()
  if(ARGN)
    target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${view}>)
  endif()
endfunction()

function(ipos_layer name)
  cmake_parse_arguments(LAYER "" "" "FOLDERS;SOURCES;USES;LIBS" ${ARGN})
  list(TRANSFORM LAYER_USES PREPEND ipos::)
  if(NOT LAYER_SOURCES)
    add_library(ipos_${name} INTERFACE)
    add_library(ipos::${name} ALIAS ipos_${name})
    ipos_see(ipos_${name} INTERFACE ${LAYER_FOLDERS})
    target_link_libraries(ipos_${name} INTERFACE ${LAYER_USES})
    return()
  endif()
  add_library(ipos_${name} STATIC ${LAYER_SOURCES})
  add_library(ipos::${name} ALIAS ipos_${name})
  ipos_see(ipos_${name} PUBLIC ${LAYER_FOLDERS})
  target_link_libraries(ipos_${name} PUBLIC ${LAYER_USES} PRIVATE ipos_options ${LAYER_LIBS})
  set_target_properties(ipos_${name} PROPERTIES IPOS_FUZZED ON)
  ipos_for_shared_libraries(ipos_${name})
  if("fmt::fmt" IN_LIST LAYER_LIBS)
    ipos_precompiled(ipos_${name})
  endif()
endfunction()
