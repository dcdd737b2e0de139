// By group, bits and the words of parameters, process data and faults.
#include "runtime/signals/shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "runtime/bus/movilink/unit_words.hpp"
#include "stdlib/faults.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr std::string_view kShapeKinds[] = {"curve", "level", "word", "words"};
constexpr size_t kMostBits = 16;  // of a word with a lane a bit; longer ones are shown as their number
constexpr uint8_t kStatusWord1 = 6;  // among the assignments of P873 to P875
constexpr int64_t kFaultBit = 1 << 5;

std::string fault_text(const stdlib::FaultRow& row) { return fmt::format("F{:02} {}", row.number, row.name); }

// Status word 1 says in its high byte the condition of the unit, or the number of its fault.
void add_status(Shape& shape) {
  shape.mask = 0xFF00 | kFaultBit;
  for (const auto& [code, text] : unit_state_texts(kStatusWord1)) shape.texts.emplace_back(int64_t{code} << 8, text);
  for (const stdlib::FaultRow& row : stdlib::fault_table())
    shape.texts.emplace_back(int64_t{row.number} << 8 | kFaultBit, fault_text(row));
}

// What a process word is assigned to now.
std::optional<uint8_t> assignment(const Signal& signal) {
  if (signal.owner == nullptr || signal.group != Group::ProcessData || signal.number == UINT32_MAX) return std::nullopt;
  const bool input = signal.own_name().starts_with("PI");
  const uint32_t word = signal.number % kProcessWords;
  const auto* row = stdlib::parameter_table(*signal.owner->config().unit)
                        .find(std::string_view(fmt::format("87{}", (input ? 3 : 0) + word)));
  if (row == nullptr) return std::nullopt;
  return static_cast<uint8_t>(signal.owner->drive().parameters().value(row->index));
}

Shape word_of(const Signal& signal) {
  Shape shape{Shape::Kind::Word};
  const stdlib::UnitType* unit = signal.owner == nullptr ? nullptr : signal.owner->config().unit;
  const bool input = signal.is_status || signal.own_name().starts_with("PI");
  const auto code = signal.is_status ? kStatusWord1 : assignment(signal).value_or(0);
  if (unit == nullptr) return shape;
  for (const WordBit& bit : unit_word_bits(*unit, input, code)) shape.bits.emplace_back(bit.bit, bit.text);
  if (input && code == kStatusWord1) add_status(shape);
  return shape;
}

}  // namespace

std::string_view kind_text(Shape::Kind kind) { return kShapeKinds[static_cast<size_t>(kind)]; }

Shape shape_of(const Signal& signal) {
  if (signal.bits == 1) return {Shape::Kind::Level};
  if (signal.bits > 1 && signal.bits <= kMostBits) return word_of(signal);
  if (signal.bits > 1) return {Shape::Kind::Words};
  if (signal.parameter != nullptr && !signal.parameter->texts.empty()) {
    Shape shape{Shape::Kind::Words};
    for (const stdlib::ValueText& row : signal.parameter->texts) shape.texts.emplace_back(row.value, row.text);
    return shape;
  }
  if (signal.group == Group::Task) {
    if (signal.own_name().ends_with(".state"))
      return {Shape::Kind::Words, {}, {{0, "stopped"}, {1, "ready"}, {2, "waiting"}}};
    return {Shape::Kind::Words};
  }
  const bool of_unit = signal.group == Group::Drive || signal.group == Group::State;
  if (of_unit && (signal.own_name() == "fault" || signal.own_name() == "drive.fault")) {
    Shape shape{Shape::Kind::Words, {}, {{0, "no fault"}}};
    for (const stdlib::FaultRow& row : stdlib::fault_table())
      if (row.number != 0) shape.texts.emplace_back(row.number, fault_text(row));
    return shape;
  }
  return {};
}

}  // namespace ipos::signals
