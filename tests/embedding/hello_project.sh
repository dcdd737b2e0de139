# Writes the small project the packaging tests build into folder $1; its CMake code to find ipos is $2. One program
# with the compiler, if $3 is "compile", and one with the static library alone.
write_project() {
  mkdir -p "$1"
  cp "$source/examples/embedding/c/hello.c" "$1"
  cat > "$1/version.c" <<'END'
#include <ipos.h>
#include <stdio.h>
int main(void) {
  printf("%u %s\n", (unsigned)ipos_version(), ipos_status_text(IPOS_OK));
  return ipos_version() == IPOS_VERSION && ipos_most_variables() == IPOS_VARIABLES ? 0 : 1;
}
END
  cat > "$1/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.25)
project(hello LANGUAGES C CXX)
$2
add_executable(version version.c)
target_link_libraries(version PRIVATE ipos::ipos)
END
  [ "$3" != compile ] || cat >> "$1/CMakeLists.txt" <<'END'
add_executable(hello hello.c)
target_link_libraries(hello PRIVATE ipos::compile)
END
}
