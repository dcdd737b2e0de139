// Texts of statuses, version and features.
#include "embed/include/ipos.h"
#include "vm/host/build.hpp"

const char* ipos_status_text(ipos_status status) {
  switch (status) {
#define IPOS_STATUS_ROW(name, number, text) \
  case name: return text;
    IPOS_STATUSES(IPOS_STATUS_ROW)
#undef IPOS_STATUS_ROW
  }
  return "";
}

uint32_t ipos_version(void) { return IPOS_VERSION; }
uint32_t ipos_features(void) { return ipos::vm::kFastEngine ? IPOS_FEATURE_FAST : 0; }
uint32_t ipos_most_variables(void) { return ipos::vm::kMaxVariables; }
uint32_t ipos_most_words(void) { return ipos::vm::kMaxProgramWords; }
