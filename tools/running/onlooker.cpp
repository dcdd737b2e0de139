// The one that the program has.
#include "tools/running/onlooker.hpp"

#include <utility>

namespace ipos::tools {
namespace {

MakeOnlooker& maker() {
  static MakeOnlooker make;
  return make;
}

}  // namespace

void use_onlookers(MakeOnlooker make) { maker() = std::move(make); }

std::unique_ptr<Onlooker> onlooker_of(runtime::Plant& plant, const std::string& file) {
  return maker() ? maker()(plant, file) : nullptr;
}

}  // namespace ipos::tools
