// Which dictionary explains a frame.
#include "runtime/bus/words/can_words.hpp"

#include <fmt/format.h>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/movilink/identifiers.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kLines = 100;  // a log of more names is noise: those after are heard as one (ours)

}  // namespace

std::string identifier_text(const CanLineNames& names, bool canopen, uint32_t id) {
  const Frame frame(id, 0);
  if (concerns(names.movilink, frame)) {
    if (const ObjectNames* object = names.movilink.object(id))
      return fmt::format("object of {}", object->station);
    const SbusIdentifier identifier = *classify_identifier(id);
    const TelegramType& type = telegram_type(identifier.telegram);
    const UnitNames* unit = type.grouped ? nullptr : names.movilink.unit_at(identifier.address);
    return unit != nullptr ? fmt::format("{} of {}", type.text, unit->name)
                           : fmt::format("{} of group {}", type.text, identifier.address);
  }
  const auto addressed = canopen::connection_of(id);
  if (!addressed || (!canopen && names.nodes.empty())) return {};
  const std::string_view text = row_of(addressed->connection).text;
  if (addressed->node == 0) return std::string(text);
  for (const canopen::NodeName& node : names.nodes)
    if (node.node == addressed->node) return fmt::format("{} of {}", text, node.name);
  return fmt::format("{} of node {}", text, addressed->node);
}

CanLineWords::CanLineWords(CanLineNames names, bool unknown_nodes) : names_(std::move(names)) {
  if (unknown_nodes || !names_.nodes.empty()) canopen_.emplace(names_.nodes);
}

Description CanLineWords::describe(const Frame& frame) {
  return is_canopen(frame) ? canopen_->describe(frame) : runtime::describe(names_.movilink, frame);
}

void CanLineWords::use(CanLineNames names) {
  names_ = std::move(names);
  if (!canopen_ && !names_.nodes.empty()) canopen_.emplace();
  for (const canopen::NodeName& node : names_.nodes) canopen_->name(node);
}

CanLineWords& CanWords::listened(std::string_view line) {
  if (const auto found = lines_.find(line); found != lines_.end()) return found->second;
  const std::string name(lines_.size() < kLines ? line : std::string_view());
  return lines_.emplace(name, CanLineWords(names_of(name), names_->canopen)).first->second;
}

const CanLineNames& CanWords::names_of(const std::string& line) const {
  const auto known = names_->lines.find(line);
  return known == names_->lines.end() ? names_->all : known->second;
}

void CanWords::use(CanNames names) {
  names_ = std::make_shared<CanNames>(std::move(names));
  for (auto& [line, words] : lines_) words.use(names_of(line));
}

}  // namespace ipos::runtime
