// Abort codes in words, and from return codes.
#include "runtime/bus/canopen/abort.hpp"

namespace ipos::runtime::canopen {

std::string_view abort_text(uint32_t code) {
#define ABORT(name, value, text) \
  if (code == (value)) return text;
#include "runtime/bus/canopen/abort_codes.def"
  return {};
}

Abort abort_of(stdlib::ReturnCode code) {
  namespace return_codes = stdlib::return_codes;
#define REFUSED(return_code, abort) \
  if (code == return_codes::k##return_code) return Abort::abort;
#include "runtime/bus/canopen/abort_codes.def"
  return Abort::General;
}

}  // namespace ipos::runtime::canopen
