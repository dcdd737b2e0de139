// The code of toml++ for the static binary: Debian has its library as a shared object only, and its sources as a header.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
