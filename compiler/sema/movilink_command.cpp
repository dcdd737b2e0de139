// MOVLNK: bus, address, format, service and index (1053 1610 p. 47; MOVITRAC 07 chapter 5.1), and the variables of MLDATA
// that the format uses.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/sema/command_check.hpp"
#include "compiler/sema/command_writes.hpp"
#include "stdlib/index_areas.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/services.hpp"

namespace ipos::compiler {
namespace {

using stdlib::Trait;


constexpr int32_t kSbusAddresses = 64;  // 1053 1610 p. 41
constexpr int32_t kGroups = 100;        // added to the number of a group

struct BusRow {
  int32_t code;
  bool every;
  Trait trait;
  bool exchanges;
  const char* text;
};
constexpr Trait Every{};
constexpr bool is_every(const char* units) { return std::string_view(units) == "Every"; }
const std::vector<BusRow>& buses() {
  using enum Trait;
  static const std::vector<BusRow> rows = {
#define MOVILINK_BUS(name, code, units, text) {code, is_every(#units), units, true, text},
#define ABSENT_BUS(code, units, text) {code, is_every(#units), units, false, text},
#include "stdlib/movilink_buses.def"
  };
  return rows;
}

// "P130" where a number of the keypad stands in the place of an index.
const stdlib::Parameter* by_number(int32_t index, const stdlib::UnitType& unit) {
  if (index < 1 || index > 999) return nullptr;
  const stdlib::Parameter* found = stdlib::parameter_table(unit).find(fmt::format("P{:03}", index));
  return found != nullptr && found->index > 999 ? found : nullptr;
}

}  // namespace

std::optional<LinkFormat> link_format(int32_t code) {
  const int32_t base = code >= 128 ? code - 128 : code;
  if (base < 0 || base > 6) return std::nullopt;
  if (base == 6) return LinkFormat{true, 0};
  return LinkFormat{base % 2 == 0, static_cast<uint32_t>(base / 2 + 1)};
}

void CommandCheck::check_movilink(const Point& point) {
  const uint32_t first = order_block(point.call).first;
  check_bus(point, first);
  const KnownValue* address = flow_.only(first + MovlnkMember::Address);
  Exchange& exchange = exchanges_[&point.expr];
  exchange.own_unit = address != nullptr && address->value == kOwnUnitAddress;
  refuse(Diag::MovilinkValue, first + MovlnkMember::Format, [](int32_t value) {
    return link_format(value) ? std::string() : fmt::format("Format {} is none of 0 to 6 and 128 to 134", value);
  });
  const KnownValue* format = flow_.only(first + MovlnkMember::Format);
  if (format == nullptr) return;
  const auto known = link_format(format->value);
  if (!known || known->parameter) check_parameter(point, first);
  if (!known) return;
  const KnownValue* pointer = flow_.only(first + MovlnkMember::DPointer);
  if (pointer == nullptr) return;
  if (pointer->value >= 0) exchange.data = static_cast<uint32_t>(pointer->value);
  if (!beyond_unit(point, *pointer, known->words > 0 ? 5 + known->words : 2))
    check_movilink_data(point, format->value, *pointer);
}

void CommandCheck::check_bus(const Point& point, uint32_t first) {
  std::vector<int32_t> codes;
  for (const BusRow& row : buses())
    if (row.exchanges && (row.every || context_.unit.has(row.trait))) codes.push_back(row.code);
  std::sort(codes.begin(), codes.end());
  const auto has = [&](int32_t code) { return std::find(codes.begin(), codes.end(), code) != codes.end(); };
  const std::span<const KnownValue> addresses = flow_.values(first + MovlnkMember::Address);
  const bool own = std::any_of(addresses.begin(), addresses.end(), [](const KnownValue& one) { return one.value == kOwnUnitAddress; });
  if (!own)
    refuse(Diag::MovilinkValue, first + MovlnkMember::BusType, [&](int32_t value) {
      return has(value) ? std::string()
                        : fmt::format("BusType {} is no bus of {}, which has {}", value, context_.unit.name,
                                      fmt::join(codes, ", "));
    });
  const KnownValue* bus = flow_.only(first + MovlnkMember::BusType);
  const bool addressed = !addresses.empty() && addresses.back().assigned();
  if (bus != nullptr && !bus->assigned() && !own && addressed) {
    warn(Diag::MovilinkValue, point.expr.span,
         {fmt::format("BusType of '{}' is never set, and there is no bus 0", name_of(first))});
    return;
  }
  if (bus == nullptr || (bus->value != 5 && bus->value != 8)) return;
  refuse(Diag::MovilinkValue, first + MovlnkMember::Address, [](int32_t value) {
    const int32_t base = value >= kGroups ? value - kGroups : value;
    if (value == kOwnUnitAddress || (base >= 0 && base < kSbusAddresses)) return std::string();
    return fmt::format("address {} does not exist on an SBus: units have 0 to 63, groups 100 to 163, 253 is the own unit",
                       value);
  });
}

void CommandCheck::check_parameter(const Point& point, uint32_t first) {
  refuse(Diag::MovilinkValue, first + MovlnkMember::Service, [](int32_t value) {
    const auto service = value < 0 ? std::nullopt : stdlib::service_from_code(static_cast<uint32_t>(value));
    return service && *service != stdlib::Service::None
               ? std::string()
               : fmt::format("service {} is none of 1 to 8; ML_S_RD reads, ML_S_WR writes", value);
  });
  const KnownValue* service = flow_.only(first + MovlnkMember::Service);
  const KnownValue* index = flow_.only(first + MovlnkMember::Index);
  if (service != nullptr && !service->assigned() && index != nullptr && index->assigned())
    warn(Diag::MovilinkValue, point.expr.span,
         {fmt::format("Service of '{}' is never set, so nothing is read or written; ML_S_RD reads, ML_S_WR writes",
                      name_of(first))});
  const bool variable = index != nullptr && index->value >= stdlib::kFirstVariables && index->value < stdlib::kFirstProgram;
  const bool writes = service != nullptr && service->value > 0 &&
                      stdlib::is_write(static_cast<stdlib::Service>(service->value));
  exchanges_[&point.expr].writes = writes;
  if (writes && service->value == static_cast<int32_t>(stdlib::Service::Write) && index != nullptr && !variable)
    kept_.insert(&point.expr);
  refuse(Diag::MovilinkValue, first + MovlnkMember::Index, [&](int32_t value) {
    const stdlib::Parameter* meant = by_number(value, context_.unit);
    return meant == nullptr ? std::string()
                            : fmt::format("{} is the number of P{}, whose index is {}", value, meant->number, meant->index);
  });
}

// WritePar ReadPar PO1 PO2 PO3 PI1 PI2 PI3: what the format uses of it.
void CommandCheck::check_movilink_data(const Point& point, int32_t format, const KnownValue& pointer) {
  const LinkFormat used = *link_format(format);
  const uint32_t count = used.words > 0 ? 5 + used.words : 2;
  const uint32_t structure = order_block(point.call).first;
  const auto data = static_cast<uint32_t>(pointer.value);
  if (data + count > structure && data < structure + order_block(point.call).size) {
    warn(Diag::OwnDefinition, place(pointer, point), {"read into", name_of(structure)});
    return;
  }
  const Reach all = reach(pointer.value, count);
  if (!is_neighbour(all)) return;
  Diagnostic* message =
      warn(Diag::DataBeyondVariable, place(pointer, point),
           {fmt::format("this format of MOVLNK"), fmt::format("{}", count), all.first->name, fmt::format("{}", all.own),
            all.beyond->name, "used"});
  if (message != nullptr) message->notes.push_back({all.beyond->span, "it is declared here"});
}

}  // namespace ipos::compiler
