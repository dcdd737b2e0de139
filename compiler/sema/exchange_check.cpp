// MLDATA is WritePar ReadPar PO1 PO2 PO3 PI1 PI2 PI3 (1053 1610 p. 47). A read brings ReadPar, process data bring PI words.
#include "compiler/sema/exchange_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/command_check.hpp"
#include "compiler/sema/command_writes.hpp"
#include "stdlib/services.hpp"

namespace ipos::compiler {
namespace {

struct Brought {
  uint32_t member;
  const char* name;
};
constexpr Brought kBrought[] = {{MldataMember::ReadPar, "ReadPar"}, {MldataMember::Input, "PI1"}, {MldataMember::Input + 1, "PI2"}, {MldataMember::Input + 2, "PI3"}};

// The structure that begins so many variables behind the begin of the type is a MLDATA.
bool is_mldata(const Type& type, uint32_t offset) {
  if (type.count != 0) return is_mldata(type.element(), offset % type.element().size());
  if (type.structure == nullptr) return false;
  if (type.structure->name == "MLDATA") return offset == 0;
  for (const StructMember& member : type.structure->members)
    if (offset >= member.offset && offset < member.offset + member.type.size())
      return is_mldata(member.type, offset - member.offset);
  return false;
}

}  // namespace

void ExchangeCheck::note(const ConstantFlow::Point& point) {
  if (point.call.opcode != vm::Opcode::Movlnk) return;
  const uint32_t first = order_block(point.call).first;
  const std::span<const KnownValue> formats = flow_.values(first + MovlnkMember::Format);
  const std::span<const KnownValue> services = flow_.values(first + MovlnkMember::Service);
  const std::span<const KnownValue> pointers = flow_.values(first + MovlnkMember::DPointer);
  pointers_.insert(first + MovlnkMember::DPointer);
  unknown_ = unknown_ || pointers.empty();
  const auto writes = [](const KnownValue& known) {
    return known.value > 0 && stdlib::is_write(static_cast<stdlib::Service>(known.value));
  };
  for (const KnownValue& pointer : pointers) {
    Data& data = data_[static_cast<uint32_t>(pointer.value)];
    bool parameter = formats.empty();
    uint32_t words = formats.empty() ? 3 : 0;
    for (const KnownValue& format : formats) {
      const auto known = link_format(format.value);
      parameter = parameter || !known || known->parameter;
      words = std::max(words, known ? known->words : 3);
    }
    const bool all_write = !services.empty() && std::all_of(services.begin(), services.end(), writes);
    data.words = std::max(data.words, words);
    data.parameter = data.parameter || parameter;
    data.reads = data.reads || (parameter && !all_write);
    const bool all_parameter = !formats.empty() && std::all_of(formats.begin(), formats.end(), [](const KnownValue& format) {
      const auto known = link_format(format.value);
      return known && known->parameter;
    });
    if (all_write && all_parameter && pointers.size() == 1) data.writes.insert(&point.expr);
  }
}

const AccessPlace* ExchangeCheck::alive(const std::vector<AccessPlace>& places) const {
  const auto found = std::find_if(places.begin(), places.end(), [this](const AccessPlace& one) { return roots_.alive[one.function]; });
  return found == places.end() ? nullptr : &*found;
}

const Variable* ExchangeCheck::own_data(uint32_t first) const {
  for (const Variable& variable : context_.scope.variables()) {
    if (variable.storage != Storage::Global || first < variable.number || first >= variable.number + variable.type.size()) continue;
    if (first <= kLastNonVolatile || !is_mldata(variable.type, first - variable.number)) return nullptr;
    for (uint32_t n = first; n < first + MldataMember::Size; ++n) {
      if (context_.raw_names.contains(n)) return nullptr;
      const auto found = context_.accesses.find(n);
      if (found == context_.accesses.end()) continue;
      for (const AccessPlace& taken : found->second.takers)
        if (!pointers_.contains(taken.into)) return nullptr;
    }
    return &variable;
  }
  return nullptr;
}

void ExchangeCheck::check(uint32_t first, const Data& data) {
  const Variable* variable = own_data(first);
  if (variable == nullptr) return;
  for (const Brought& one : kBrought) {
    const uint32_t number = first + one.member;
    const auto found = context_.accesses.find(number);
    if (brought_.contains(number) || found == context_.accesses.end() || !found->second.writers.empty()) continue;
    const AccessPlace* reader = alive(found->second.readers);
    if (reader == nullptr) continue;
    const std::string reason = one.member != MldataMember::ReadPar ? data.words == 0 ? "its exchanges carry no process data"
                                                                        : fmt::format("its exchanges carry {} words of process data", data.words)
                               : data.parameter       ? "a write brings no value back"
                                                      : "its exchanges carry no parameter";
    context_.diagnostics.report(Diag::ExchangeData, reader->span, {one.name, variable->name, reason});
  }
  const auto value = context_.accesses.find(first);
  if (value != context_.accesses.end() && !value->second.writers.empty()) return;
  for (const checked::Expr* command : data.writes)
    context_.diagnostics.report(Diag::ValueForgotten, command->span, {variable->name});
}

void ExchangeCheck::run() {
  if (unknown_) return;
  for (const auto& [first, data] : data_) {
    if (data.reads) brought_.insert(first + MldataMember::ReadPar);
    for (uint32_t n = 0; n < data.words; ++n) brought_.insert(first + MldataMember::Input + n);
  }
  for (const auto& [first, data] : data_) check(first, data);
}

}  // namespace ipos::compiler
