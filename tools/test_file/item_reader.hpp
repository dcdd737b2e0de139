// What the readers of a test file's tables share. Only they include this; it needs toml++.
#pragma once

#include "runtime/plant_file/plant_reader.hpp"
#include "tools/test_file/test_case.hpp"

namespace ipos::tools::testing {

using runtime::place_of;
using runtime::PlantReader;

// The keys when and why of every item.
#define IPOS_ITEM_KEYS "at", "after", "note"

// `station`; of a plant with one station it may be left out. `gateway_too`: it may be a gateway.
std::string read_item_station(PlantReader& reader, const toml::table& table, std::string_view what,
                              bool gateway_too = false);
// The bus of the table, which must exist; nullptr with an error.
const runtime::BusConfig* read_item_bus(PlantReader& reader, const toml::table& table, std::string_view what);
// "PO1" to "PO3", with `inputs` also "PI1" to "PI3"; nothing with an error.
std::optional<std::string> read_word(PlantReader& reader, const toml::node& node, bool inputs);

// The plant must have been read.
std::optional<Step> read_step(PlantReader& reader, const toml::table& table);
std::optional<Expect> read_expect(PlantReader& reader, const toml::table& table);
// A frame or telegram that a step waits for.
std::optional<Expect> read_await(PlantReader& reader, const toml::table& table);

}  // namespace ipos::tools::testing
