// [[control]] with kind = "fms": a master of FMS on a PROFIBUS, its connections, and what it asks when.
#include <algorithm>

#include "runtime/plant_file/bytes_text.hpp"
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

namespace fms = profibus::fms;

class FmsReader {
 public:
  FmsReader(PlantReader& reader, FmsMasterConfig& config) : reader_(reader), config_(config) {}

  void read_slave(const toml::table& table) {
    reader_.known_keys(table, "[[control.slave]] of an FMS master", {"address", "connection", "features", "pdu", "counters", "request"});
    if (!table.contains("address")) reader_.error(place_of(table), "a [[control.slave]] needs address = ...");
    FmsMasterConfig::Link link;
    link.address = static_cast<uint8_t>(reader_.count(table, "address", profibus::kLastStation, 0));
    constexpr uint8_t kUsual = 7;  // acyclic, with all services
    const auto cref = static_cast<uint8_t>(reader_.count(table, "connection", UINT8_MAX, kUsual));
    link.connection = fms::find_connection(cref);
    if (link.connection == nullptr) {
      reader_.error(place_of(*table.get("connection")), "connection is 2 to 8, as the communication relationship list has them");
      link.connection = fms::find_connection(kUsual);
    }
    link.entry = fms::master_entry(*link.connection, link.address);
    read_entry(table, link.entry);
    config_.links.push_back(link);
    reader_.for_each_table(table, "request", [&](const toml::table& request) { read_request(request); });
  }

 private:
  // What differs from the entry that fits.
  void read_entry(const toml::table& table, fms::MasterEntry& entry) {
    if (const auto octets = read_octets(table, "features", 6)) {
      uint64_t bits = 0;
      for (const uint8_t octet : *octets) bits = bits << 8 | octet;
      entry.features = fms::Features(bits);
    }
    if (const auto counts = read_octets(table, "counters", 4)) entry.counters = {(*counts)[0], (*counts)[1], (*counts)[2], (*counts)[3]};
    if (const auto sizes = read_octets(table, "pdu", 4)) entry.pdu = {(*sizes)[0], (*sizes)[1], (*sizes)[2], (*sizes)[3]};
  }

  // `size` 0: any.
  std::optional<profibus::Octets> read_octets(const toml::table& table, std::string_view key, size_t size) {
    const std::string text = reader_.text(table, key, "", false);
    if (!table.contains(key)) return std::nullopt;
    auto octets = parse_bytes(text);
    if (octets && (size == 0 || octets->size() == size)) return octets;
    reader_.error(place_of(*table.get(key)), size == 0 ? fmt::format("{} are octets, for example \"00 00 09 50\"", key)
                                                       : fmt::format("{} are {} octets in hexadecimal", key, size));
    return std::nullopt;
  }

  void read_request(const toml::table& table) {
    constexpr std::string_view kWhat = "a [[control.slave.request]]";
    std::vector<std::string_view> keys{"at", "every", "data"};
    const fms::ServiceKey* found = nullptr;  // its value is an index, or true
    size_t services = 0;
    for (const fms::ServiceKey& row : fms::kServiceKeys) {
      keys.push_back(row.key);
      if (!table.contains(row.key)) continue;
      found = &row;
      ++services;
    }
    reader_.known_keys(table, "[[control.slave.request]]", keys);
    if (services != 1)
      return reader_.error(place_of(table), fmt::format("{} does one thing: {}", kWhat, fms::service_keys()));
    FmsMasterConfig::Request request;
    request.link = config_.links.size() - 1;
    request.at = reader_.duration(table, "at", 0);
    request.every = reader_.duration(table, "every", 0);
    if (table.contains("every") && request.every < kShortest)
      reader_.error(place_of(*table.get("every")), "every is less than a millisecond");
    request.request.service = found->service;
    if (fms::service_type(found->service).of_object)
      request.request.index = static_cast<uint16_t>(reader_.count(table, found->key, UINT16_MAX, 0));
    else if (!reader_.flag(table, found->key).value_or(false))
      reader_.error(place_of(*table.get(found->key)), fmt::format("write {} = true", found->key));
    const auto data = read_octets(table, "data", 0);
    if ((found->service == fms::Service::Write) != table.contains("data"))
      reader_.error(place_of(table), "data = \"...\" belongs to write, and there it must be");
    if (data) request.request.data = *data;
    config_.requests.push_back(std::move(request));
  }

  PlantReader& reader_;
  FmsMasterConfig& config_;
};

}  // namespace

void read_fms_master(PlantReader& reader, const toml::table& table, ControlConfig& control) {
  reader.known_keys(table, "[[control]] with kind fms", {"name", "kind", "profibus", "address", "gap", "slave"});
  auto& config = control.kind.emplace<FmsMasterConfig>();
  config.bus = reader.bus_use(table, "profibus", BusKind::Profibus).bus;
  if (config.bus.empty() && !table.contains("profibus")) reader.error(control.place, "a [[control]] with kind fms needs profibus = \"...\"");
  constexpr uint8_t kUsualAddress = 2;  // beside a DP master at 1
  config.settings.address = static_cast<uint8_t>(reader.count(table, "address", profibus::kLastStation, kUsualAddress));
  config.settings.gap_factor = reader.count(table, "gap", 1000, config.settings.gap_factor);
  FmsReader master(reader, config);
  reader.for_each_table(table, "slave", [&](const toml::table& slave) { master.read_slave(slave); });
}

}  // namespace ipos::runtime
