// Every object of the EDS over a line, against the parameters of a real unit: read in its length; written at its
// limits and beyond; refused where it is read only. The EDS text alone says what is expected.
#include <gtest/gtest.h>

#include <cstdio>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "runtime/bus/canopen/eds.hpp"
#include "runtime/bus/canopen/sdo_client.hpp"
#include "runtime/drive/parameters.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/canopen/node_rig.hpp"

namespace ipos::tests {
namespace {

// The parameters of a MOVIDRIVE B whose drive stands still.
struct Parameters final : ParameterServer {
  tl::expected<int32_t, ReturnCode> serve(Time, const ParameterRequest& request) override {
    const auto reply = store.execute(static_cast<uint8_t>(request.service), request.index, request.value);
    if (store.factory_setting_running()) store.finish_factory_setting();
    return reply;
  }
  ParameterStore store{mdxb()};
};

struct Entry {
  Address address;
  unsigned type = 0;
  bool writable = false;
  std::optional<int64_t> low, high, value;
};

int64_t number_of(const std::string& text) {
  if (text.starts_with("$NODEID+")) return 5 + std::stoll(text.substr(8), nullptr, 0);
  return std::stoll(text, nullptr, 0);
}

std::vector<Entry> entries_of(const std::string& eds) {
  std::vector<Entry> entries;
  std::istringstream text(eds);
  Entry entry;
  for (std::string line; std::getline(text, line);) {
    unsigned index = 0, sub = 0;
    const size_t equals = line.find('=');
    if (line.starts_with("[")) {
      entry = {};
      if (sscanf(line.c_str(), "[%4xsub%x]", &index, &sub) >= 1)
        entry.address = {static_cast<uint16_t>(index), static_cast<uint8_t>(sub)};
    } else if (line.starts_with("DataType=")) {
      entry.type = static_cast<unsigned>(number_of(line.substr(equals + 1)));
    } else if (line.starts_with("AccessType=")) {
      entry.writable = line.find("rw") != std::string::npos;
    } else if (line.starts_with("LowLimit=")) {
      entry.low = number_of(line.substr(equals + 1));
    } else if (line.starts_with("HighLimit=")) {
      entry.high = number_of(line.substr(equals + 1));
    } else if (line.starts_with("DefaultValue=") && equals + 1 < line.size()) {
      entry.value = number_of(line.substr(equals + 1));
    } else if (line.empty() && entry.type != 0) {
      entries.push_back(entry);
    }
  }
  return entries;
}

struct SweepRig {
  SweepRig() {
    node.start(0);
    queue.run_until(kMillisecond);
  }
  struct Port final : CanNode {
    void on_frame(Time now, const Frame& frame) override { node->on_frame(now, frame); }
    void on_sent(Time, const Frame&, uint64_t) override {}
    void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
    canopen::Node* node = nullptr;
  };

  // Runs a transfer to its end.
  tl::expected<std::vector<uint8_t>, uint32_t> run(SdoBytes request) {
    while (client.is_busy()) {
      master.frames.clear();
      master.port.send({0x605, 8, request}, 0);
      queue.run_until(queue.now() + 4 * kMillisecond);
      if (master.frames.size() != 1 || master.frames[0].id != 0x585) return tl::unexpected(0U);
      if (const auto next = client.take(master.frames[0].data)) request = *next;
    }
    return client.result();
  }
  tl::expected<std::vector<uint8_t>, uint32_t> read(Address address) { return run(client.read(address)); }
  uint32_t write(Address address, int64_t value, size_t bytes) {
    std::vector<uint8_t> data;
    for (size_t n = 0; n < bytes; ++n) data.push_back(static_cast<uint8_t>(value >> 8 * n));
    const auto written = run(client.write(address, data));
    return written ? 0 : written.error();
  }

  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Hand master{line, "master"};
  Parameters parameters;
  FakeUnit unit;
  Port port;
  LinePort sender{line, line.attach("node", line.baud(), port)};
  canopen::Node node{{queue, 1, sender, 1}, 5, mdxb(), {}, parameters, unit};
  SdoClient client;

  // The port knows its node before a frame comes.
  const bool connected = (port.node = &node, true);
};

size_t bytes_of_type(unsigned type) { return type == 5 ? 1 : type == 6 ? 2 : 4; }

// Codes that only another firmware or the LOGODrive knows are in the list and refused here.
bool is_for_others(const Parameters& parameters, Address address, int64_t value) {
  const stdlib::Parameter* row = parameters.store.table().find(address.index);
  for (const stdlib::ValueText& text : row->texts)
    if (text.value == value) return text.logodrive_only || text.from_standard != 0;
  return false;
}

TEST(CanopenSweep, EveryObjectOfTheEds) {
  PROVES("MDB-TOC-16", "MDB-TOC-17", "MDB-TOC-19");
  SweepRig rig;
  size_t reads = 0, limits = 0, beyond = 0, read_only = 0;
  for (const Entry& entry : entries_of(eds_text(mdxb()))) {
    const Address at = entry.address;
    const std::string name = entry_name(at) + " " + std::to_string(at.index) + ":" + std::to_string(at.sub);
    const auto value = rig.read(at);
    if (at.index == 0x1003 && at.sub > 0) {  // no error has been stored (CiA 301, 1003h)
      EXPECT_FALSE(value.has_value()) << name;
      ++reads;
      continue;
    }
    ASSERT_TRUE(value.has_value()) << name;
    if (entry.type != 9) {
      EXPECT_EQ(value->size(), bytes_of_type(entry.type)) << name;
    }
    ++reads;
    if (!entry.writable) {
      EXPECT_EQ(rig.write(at, 0, 4), 0x0601'0002U) << name;
      ++read_only;
      continue;
    }
    if (at.index < 8300) continue;  // their rules: object_test.cpp
    for (const auto& limit : {entry.low, entry.high})
      if (limit && !is_for_others(rig.parameters, at, *limit)) {
        EXPECT_EQ(rig.write(at, *limit, 4), 0U) << name << " := " << *limit;
        rig.write(at, *entry.value, 4);
        ++limits;
      }
    const int64_t lowest = entry.type == 7 ? 0 : INT32_MIN;
    const int64_t highest = entry.type == 7 ? UINT32_MAX : INT32_MAX;
    if (entry.low && *entry.low > lowest && entry.type != 7) {
      EXPECT_EQ(rig.write(at, *entry.low - 1, 4), 0x0609'0032U) << name;
      ++beyond;
    }
    if (entry.high && *entry.high < highest) {
      EXPECT_EQ(rig.write(at, *entry.high + 1, 4), 0x0609'0031U) << name;
      ++beyond;
    }
    EXPECT_EQ(rig.write(at, *entry.value, 2), 0x0607'0010U) << name;
  }
  EXPECT_EQ(reads, stdlib::parameter_table(mdxb()).by_index().size() + 27 + 104 + 22);
  EXPECT_GT(limits, 300U);
  EXPECT_GT(beyond, 300U);
  EXPECT_GT(read_only, 100U);
}

}  // namespace
}  // namespace ipos::tests
