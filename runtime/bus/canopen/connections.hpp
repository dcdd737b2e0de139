// The identifiers of a CANopen line by the pre-defined connection set (CiA 301; pages 52-56 of the MDX60B/61B
// manual 11264926 use the same ones).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace ipos::runtime::canopen {

inline constexpr uint8_t kMaxNode = 127;
constexpr bool is_node(uint32_t node) { return node >= 1 && node <= kMaxNode; }

enum class Connection : uint8_t {
#define CONNECTION(name, base, addressed, from_node, text) name,
#include "runtime/bus/canopen/connections.def"
};

struct ConnectionRow {
  Connection connection;
  uint16_t base;
  bool addressed;
  bool from_node;
  std::string_view text;
};

inline constexpr ConnectionRow kConnections[] = {
#define CONNECTION(name, base, addressed, from_node, text) \
  {Connection::name, base, addressed, from_node, text},
#include "runtime/bus/canopen/connections.def"
};

constexpr const ConnectionRow& row_of(Connection connection) {
  return kConnections[static_cast<size_t>(connection)];
}

// `node` counts for addressed messages only.
constexpr uint32_t identifier(Connection connection, uint8_t node = 0) {
  const ConnectionRow& row = row_of(connection);
  return row.base + (row.addressed ? uint32_t{node} : 0U);
}

struct Addressed {
  Connection connection;
  uint8_t node;  // 0: to all
  friend bool operator==(const Addressed&, const Addressed&) = default;
};

// Rows of kConnections by the upper four of the eleven bits of an identifier: that of the nodes, and that to all.
struct FunctionCode {
  const ConnectionRow* nodes = nullptr;
  const ConnectionRow* all = nullptr;
};
inline constexpr auto kFunctionCodes = [] {
  std::array<FunctionCode, 16> codes{};
  for (const ConnectionRow& row : kConnections) (row.addressed ? codes[row.base >> 7].nodes : codes[row.base >> 7].all) = &row;
  return codes;
}();
static_assert(std::all_of(std::begin(kConnections), std::end(kConnections),
                          [](const ConnectionRow& row) { return (row.base & kMaxNode) == 0 && row.base >> 7 < 16; }));

// Nothing for an identifier outside of the set.
constexpr std::optional<Addressed> connection_of(uint32_t id) {
  if (id >> 7 >= kFunctionCodes.size()) return std::nullopt;
  const auto node = static_cast<uint8_t>(id & kMaxNode);
  const FunctionCode& code = kFunctionCodes[id >> 7];
  const ConnectionRow* const row = node == 0 ? code.all : code.nodes;
  if (row == nullptr) return std::nullopt;
  return Addressed{row->connection, node};
}

// All identifiers of a node, and those to all nodes.
inline std::vector<uint32_t> identifiers_of(uint8_t node) {
  std::vector<uint32_t> ids;
  for (const ConnectionRow& row : kConnections) ids.push_back(identifier(row.connection, node));
  return ids;
}

// Identifiers that CiA 301 keeps from being chosen for PDO, SYNC and EMCY.
constexpr bool is_restricted(uint32_t id) {
  return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) ||
         (id >= 0x601 && id <= 0x67F) || (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

}  // namespace ipos::runtime::canopen
