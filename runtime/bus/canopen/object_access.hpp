// The objects of a node as SDO reaches them: the dictionary with the rules of its entries, and after it every
// parameter of the unit under its own index with sub-index 0, four bytes, low byte first (page 55 of 11264926).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/bus/canopen/abort.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"
#include "runtime/bus/canopen/unit.hpp"
#include "runtime/bus/movilink/unit_servers.hpp"
#include "runtime/clock/event_queue.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime::canopen {

// What an SDO server serves.
class ObjectServer {
 public:
  virtual tl::expected<std::vector<uint8_t>, Abort> read(Time now, Address address) = 0;
  // Why a download need not begin, whatever its data; nothing when it may.
  virtual std::optional<Abort> refuses(Time now, Address address) = 0;
  virtual std::optional<Abort> write(Time now, Address address, std::span<const uint8_t> data) = 0;

 protected:
  ~ObjectServer() = default;
};

class ObjectAccess final : public ObjectServer {
 public:
  class Listener {
   public:
    virtual void on_written(Time now, Address address, Rule rule) = 0;

   protected:
    ~Listener() = default;
  };

  // `state` is that of the node.
  ObjectAccess(ObjectDictionary& dictionary, const stdlib::UnitType& type, ParameterServer& parameters,
               Unit& unit, const State& state, Listener& listener);

  tl::expected<std::vector<uint8_t>, Abort> read(Time now, Address address) override;
  std::optional<Abort> refuses(Time now, Address address) override;
  std::optional<Abort> write(Time now, Address address, std::span<const uint8_t> data) override;

 private:
  tl::expected<std::vector<uint8_t>, Abort> read_parameter(Time now, Address address);
  std::optional<Abort> write_parameter(Time now, Address address, std::span<const uint8_t> data);
  std::string text(Time now, Rule rule);
  std::optional<Abort> check(Time now, const ObjectDictionary::Entry& entry, uint32_t value);
  std::optional<Abort> check_pdo_id(Address address, uint32_t old, uint32_t value) const;
  std::optional<Abort> check_mapping_count(Time now, uint16_t index, uint32_t count);
  std::optional<Abort> check_mapped(Time now, uint16_t mapping_index, uint32_t entry);
  bool pdo_is_on(uint16_t index) const;

  ObjectDictionary& dictionary_;
  const stdlib::UnitType& type_;
  ParameterServer& parameters_;
  Unit& unit_;
  const State& state_;
  Listener& listener_;
};

}  // namespace ipos::runtime::canopen
