// Which dictionary explains a frame.
#include "runtime/bus/can_words.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kLines = 100;  // a log of more names is noise: those behind are heard as one (ours)

}  // namespace

CanWords::Listened& CanWords::listened(std::string_view line) {
  if (const auto found = lines_.find(line); found != lines_.end()) return found->second;
  const std::string name(lines_.size() < kLines ? line : std::string_view());
  const auto known = names_->lines.find(name);
  const CanLineNames& names = known == names_->lines.end() ? names_->all : known->second;
  Listened& added = lines_.emplace(name, Listened{&names, {}}).first->second;
  if (!added.canopen && (names_->canopen || !names.nodes.empty())) added.canopen.emplace(names.nodes);
  return added;
}

Description CanWords::describe(std::string_view line, const Frame& frame) {
  Listened& heard = listened(line);
  if (!heard.canopen || concerns(heard.names->movilink, frame))
    return runtime::describe(heard.names->movilink, frame);
  return heard.canopen->describe(frame);
}

}  // namespace ipos::runtime
