// ipos fms: services of FMS of a PROFIBUS station, in a plant or at a port.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <memory>
#include <utility>

#include "runtime/plant_file/bytes_text.hpp"
#include "runtime/station/dp_slaves.hpp"
#include "runtime/station/fms_control.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/links/dp_station.hpp"
#include "tools/links/link_options.hpp"

namespace ipos::tools {
namespace {

namespace fms = profibus::fms;

struct FmsFlags {
  LinkFlags link;
  std::string where;    // plant or port
  std::string station;  // name, or address at a port
  std::vector<std::string> words;
  int connection = 7;
  std::string at = "1s";
  CompileFlags compile;
};

constexpr runtime::Time kLimit = 60 * runtime::kSecond;  // of virtual time, for a service in a plant
// A slave that hears nobody else has to find the rate first (ours).
constexpr runtime::Time kJoining = 2 * runtime::kSecond;

using Ask = std::function<fms::Response(const fms::Request&)>;

bool is_unheard(const fms::Response& response) {
  return response.end == fms::End::Aborted && response.reason == static_cast<uint8_t>(fms::Reason::NoAnswer);
}

// A slave answers on a connection to the master alone that has opened it. Null: no master of the plant has this one.
const runtime::FmsControl* other_master(const runtime::Plant& plant, std::string_view bus, uint8_t slave,
                                        const fms::Connection& connection) {
  for (const runtime::FmsControl* const master : plant.all<runtime::FmsControl>())
    for (const runtime::FmsMasterConfig::Link& link : master->settings().links)
      if (master->settings().bus == bus && link.address == slave && link.connection == &connection) return master;
  return nullptr;
}

// The plant runs until the time, and on until each answer is there.
Ask ask_in_plant(const FmsFlags& flags, const fms::Connection& connection) {
  std::shared_ptr<runtime::Plant> plant = make_plant(read_plant_input(flags.where, flags.compile), runtime::FileUse::Look);
  const auto& stations = plant->stations();
  const auto found = std::find_if(stations.begin(), stations.end(),
                                  [&](const auto& station) { return station->config().name == flags.station; });
  if (found == stations.end()) throw Failure(kUsage, fmt::format("{} has no station '{}'", flags.where, flags.station));
  const runtime::ProfibusPort* port = std::as_const(**found).profibus();
  if (port == nullptr) throw Failure(kUsage, fmt::format("station '{}' is on no PROFIBUS", flags.station));
  plant->run_until(runtime::parse_duration(flags.at));
  const std::string bus = (*found)->config().profibus.bus.bus;
  const uint8_t address = port->card().station().slave().address();
  return [plant, &connection, bus, address, station = flags.station](const fms::Request& request) {
    auto& line = *as<runtime::ProfibusBus>(plant->find_bus(bus));
    runtime::FmsOperator& hand = runtime::fms_operator_of(*plant, line);
    hand.ask(address, connection, request);
    const runtime::Time begin = plant->now();
    fms::Response last = fms::Response::aborted(fms::Reason::NoAnswer);
    while (plant->now() < begin + kLimit) {
      plant->run_until(plant->now() + runtime::kMillisecond);
      const auto done = hand.take();
      if (!done) continue;
      last = done->response;
      if (!is_unheard(last) || plant->now() >= begin + kJoining) break;
      hand.ask(address, connection, request);
    }
    if (const runtime::FmsControl* const other = other_master(*plant, bus, address, connection); other != nullptr && is_unheard(last))
      throw Failure(kFindings, fmt::format("{}: nobody answers; '{}', a master of the plant, has connection {}: --connection takes another one",
                                           station, other->name(), connection.cref));
    return last;
  };
}

Ask ask_at_port(const FmsFlags& flags, const fms::Connection& connection) {
  int address = 0;
  const auto [end, error] = std::from_chars(flags.station.data(), flags.station.data() + flags.station.size(), address);
  if (error != std::errc() || end != flags.station.data() + flags.station.size() || address < 0 || address > profibus::kLastStation)
    throw Failure(kUsage, fmt::format("'{}' is no address: at a port the station is a number from 0 to 125", flags.station));
  LinkFlags link = flags.link;
  link.port = flags.where;
  link.profibus = true;
  check_profibus(link);
  auto line = std::make_shared<DpStation>(link);
  const auto slave = static_cast<uint8_t>(address);
  auto open = std::make_shared<fms::ClientLink>(connection, fms::master_entry(connection, slave));
  return [line, open, slave](const fms::Request& request) {
    open->ask(request);
    for (bool again = true;;) {
      auto data = open->next(line->now());
      if (!data) return fms::Response::aborted(fms::Reason::NoAnswer);
      const DpReply reply = line->fms(slave, open->connection().lsap, std::move(*data));
      const auto done = !reply.answered || reply.refused ? open->unanswered() : open->answered(line->now(), reply.data);
      if (!done) continue;
      // Somebody went away and left it open; that is an abort, and the next try opens it (MOVITRAC 31 PROFIBUS, 4.1.1).
      const bool was_open = done->response.end == fms::End::Aborted &&
                            done->response.reason == static_cast<uint8_t>(fms::Reason::WasOpen);
      if (!was_open || !std::exchange(again, false)) return done->response;
      open->ask(request);
    }
  };
}

uint16_t index_of(const std::string& text) {
  unsigned index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc() || end != text.data() + text.size() || index > UINT16_MAX)
    throw Failure(kUsage, fmt::format("'{}' is no index of an object", text));
  return static_cast<uint16_t>(index);
}

// "0006 05DC 0000", "00 00 09 50": the digits of all words together, two an octet.
profibus::Octets octets_of(std::span<const std::string> words) {
  std::string digits;
  for (const std::string& word : words)
    for (size_t n = 0; n < word.size(); ++n) {
      if (word[n] == ' ') continue;
      if (!digits.empty() && digits.size() % 3 == 2) digits += ' ';
      digits += word[n];
    }
  const auto octets = runtime::parse_bytes(digits);
  if (!octets) throw Failure(kUsage, fmt::format("'{}' are no octets; write for example 0006 05DC 0000", fmt::join(words, " ")));
  return *octets;
}

// What the words after the station ask for.
std::vector<fms::Request> requests_of(const std::vector<std::string>& words) {
  const std::string& what = words.front();
  const std::span<const std::string> rest = std::span(words).subspan(1);
  std::vector<fms::Request> requests;
  const auto service = fms::service_of_key(what);
  if (!service) throw Failure(kUsage, fmt::format("'{}' is no service; there are {}, crl", what, fms::service_keys()));
  if (!fms::service_type(*service).of_object) {
    if (!rest.empty()) throw Failure(kUsage, fmt::format("{} takes no more words", what));
    return {{*service, 0, {}}};
  }
  if (rest.empty()) throw Failure(kUsage, fmt::format("{} needs the index of an object, for example 1025", what));
  if (*service == fms::Service::Write) {
    if (rest.size() < 2) throw Failure(kUsage, "write needs an index and octets, for example write 1025 00 00 09 50");
    return {{fms::Service::Write, index_of(rest[0]), octets_of(rest.subspan(1))}};
  }
  for (const std::string& index : rest)
    requests.push_back({*service, index_of(index), {}});
  return requests;
}

int print_list() {
  fmt::print("CREF type ATTR LSAP RSAP RADR SCC RCC SAC RAC ACI/CCI; largest units sent and received; features\n");
  for (const fms::Connection& row : fms::connections()) {
    const auto octets = row.features.octets();
    fmt::print("{}; {} {} {} {}; {:02X}: {}\n", fms::describe(row), row.pdu.send_high, row.pdu.send_low, row.pdu.receive_high,
               row.pdu.receive_low, fmt::join(octets, " "), fmt::join(row.features.services(), ", "));
  }
  return kGood;
}

int run_fms(const FmsFlags& flags) {
  const fms::Connection& connection = *fms::find_connection(static_cast<uint8_t>(flags.connection));
  const bool lists = flags.words.front() == "crl";
  const std::vector<fms::Request> requests = lists ? std::vector<fms::Request>{{fms::Service::Status, 0, {}}} : requests_of(flags.words);
  const Ask ask = is_plant(flags.where) ? ask_in_plant(flags, connection) : ask_at_port(flags, connection);
  int result = kGood;
  for (const fms::Request& request : requests) {
    const fms::Response response = ask(request);
    if (response.end == fms::End::Positive) {
      if (lists) result = print_list();
      if (!lists) fmt::print("{}\n", fms::describe(response));
    } else {
      fmt::print(stderr, "ipos: {}: {}: {}\n", flags.station, fms::describe(request), fms::describe(response));
      result = kFindings;
    }
  }
  // At a port the unit goes on: it gets its connection back.
  if (!is_plant(flags.where) && result == kGood) ask({fms::Service::Abort, 0, {}});
  return result;
}

}  // namespace

void add_fms(cli::Verb& app) {
  auto flags = std::make_shared<FmsFlags>();
  cli::Verb& verb = app.verb("fms", "services of PROFIBUS-FMS: objects and connections of a station");
  verb.option("PLANT|PORT", flags->where, "plant file (.toml), or the serial port of a PROFIBUS line").required();
  verb.option("STATION", flags->station, "station of the plant, or the address at a port").required();
  verb.option("SERVICE", flags->words,
              "read INDEX..., write INDEX OCTETS..., ov INDEX... (object description), identify, status, or crl (the connections)")
      .required();
  verb.option("--connection", flags->connection, "CREF of the connection in the list of the station, 2 to 8; default 7").between(2, 8);
  verb.option("--at", flags->at, "in a plant: how long it runs before; default 1s").check(check_time, "TIME");
  add_link_options(verb, flags->link, false);
  add_plant_options(verb, flags->compile);
  verb.footer("Example:\n  ipos fms plant.toml inv read 1025\n  ipos fms /dev/ttyUSB0 8 write 1025 00 00 09 50");
  verb.runs([flags] { return run_fms(*flags); });
}

}  // namespace ipos::tools
