// The objects of one node and the SDO server before them, without a line.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>
#include <optional>
#include <vector>

#include "runtime/bus/canopen/object_access.hpp"
#include "runtime/bus/canopen/sdo_server.hpp"
#include "tests/runtime/bus/canopen/fake_unit.hpp"

namespace ipos::tests {

struct ObjectRig : ObjectAccess::Listener {
  void on_written(Time, Address address, Rule) override { written.push_back(address); }

  // The abort of a write of `length` bytes, 0 when it succeeds.
  uint32_t write(uint16_t index, uint8_t sub, uint32_t value, size_t length) {
    std::vector<uint8_t> data;
    for (size_t n = 0; n < length; ++n) data.push_back(n < 4 ? static_cast<uint8_t>(value >> 8 * n) : 0);
    const auto refused = access.write(0, {index, sub}, data);
    return refused ? static_cast<uint32_t>(*refused) : 0;
  }
  uint32_t refused_read(uint16_t index, uint8_t sub) {
    const auto value = access.read(0, {index, sub});
    return value ? 0 : static_cast<uint32_t>(value.error());
  }
  std::vector<uint8_t> read(uint16_t index, uint8_t sub = 0) {
    return access.read(0, {index, sub}).value_or(std::vector<uint8_t>{0xDE, 0xAD, 0xDE, 0xAD, 0xDE, 0xAD});
  }
  std::optional<SdoBytes> ask(const SdoBytes& request) { return server.take(0, request); }

  FakeUnit unit;
  State state = State::PreOperational;
  ObjectDictionary dictionary{5};
  ObjectAccess access{dictionary, mdxb(), unit, unit, state, *this};
  SdoServer server{access};
  std::vector<Address> written;
};

}  // namespace ipos::tests
