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

stdlib::ReturnCode return_code_of(uint32_t abort) {
#define REFUSED(return_code, refusal) \
  if (abort == static_cast<uint32_t>(Abort::refusal)) return stdlib::return_codes::k##return_code;
#include "runtime/bus/canopen/abort_codes.def"
  return {8, 0, 0xFFFF};
}

}  // namespace ipos::runtime::canopen
