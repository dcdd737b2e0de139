// Units behind a link.
#include "tools/links/link_access.hpp"

#include <fmt/format.h>

#include <map>

#include "stdlib/parameters.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {

AccessReply ask(BusLink& link, uint8_t address, stdlib::Service service, uint16_t index) {
  constexpr int kTries = 3;
  AccessReply reply = link.execute(address, service, index, 0);
  for (int n = 1; n < kTries && !reply && !reply.error().code; ++n)
    reply = link.execute(address, service, index, 0);
  return reply;
}

namespace {

class LinkAccess final : public ParameterAccess {
 public:
  LinkAccess(std::unique_ptr<BusLink> owned, BusLink& link, uint8_t address, const stdlib::UnitType& unit)
      : owned_(std::move(owned)), link_(link), address_(address), unit_(unit) {}

  AccessReply execute(stdlib::Service service, uint16_t index, int32_t value) override {
    return stdlib::is_write(service) ? link_.execute(address_, service, index, value)
                                     : ask(link_, address_, service, index);
  }
  std::string name() const override { return fmt::format("unit {} at {}", address_, link_.port_name()); }
  const stdlib::UnitType& unit() const override { return unit_; }

 private:
  std::unique_ptr<BusLink> owned_;
  BusLink& link_;
  uint8_t address_;
  const stdlib::UnitType& unit_;
};

}  // namespace

const stdlib::UnitType* identify(BusLink& link, uint8_t address, AccessError* error) {
  std::map<uint16_t, bool> answers;  // each index is asked once
  for (const stdlib::UnitSigns& signs : stdlib::unit_signs()) {
    bool all = true;
    for (const uint16_t index : signs.indices) {
      const auto [known, is_new] = answers.try_emplace(index, false);
      if (is_new) {
        const AccessReply reply = ask(link, address, stdlib::Service::Read, index);
        if (!reply && !reply.error().code) {
          if (error != nullptr) *error = reply.error();
          return nullptr;
        }
        known->second = reply.has_value();
      }
      if (!(all = known->second)) break;
    }
    if (all) return stdlib::find_unit(signs.unit);
  }
  return nullptr;
}

std::unique_ptr<ParameterAccess> open_unit(std::unique_ptr<BusLink> link, uint8_t address,
                                           const std::string& unit) {
  AccessError error;
  const stdlib::UnitType* type = unit.empty() ? identify(*link, address, &error) : stdlib::find_unit_or_plate(unit);
  const std::string place = fmt::format("unit {} at {}", address, link->port_name());
  if (!error.trouble.empty()) throw Failure(kIoError, fmt::format("{}: {}", place, error.trouble));
  if (type == nullptr)
    throw Failure(kFindings, fmt::format("{}: it answers, but has none of the parameters that tell its type; "
                                         "give --unit",
                                         place));
  BusLink& used = *link;
  return std::make_unique<LinkAccess>(std::move(link), used, address, *type);
}

std::unique_ptr<ParameterAccess> unit_at(BusLink& link, uint8_t address, const stdlib::UnitType& unit) {
  return std::make_unique<LinkAccess>(nullptr, link, address, unit);
}

}  // namespace ipos::tools
