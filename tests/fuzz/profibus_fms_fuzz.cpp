// Octets of FMS on the line: units of data in any shape are read, described and answered, random ones and good ones alike; a message
// that is understood comes back the same, and an answer fits into its frame. The same octets go to a master as answers.
#include "runtime/bus/profibus/dp_unit.hpp"
#include "runtime/bus/profibus/fms/client_link.hpp"
#include "runtime/bus/profibus/fms/slave_links.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace ipos::profibus;  // NOLINT
using namespace ipos::tests;     // NOLINT
namespace runtime = ipos::runtime;

namespace {

// Objects of all lengths.
struct Objects final : fms::ObjectList {
  std::optional<fms::Object> find(uint16_t index) const override {
    if (index < 900) return std::nullopt;
    return fms::Object{index, static_cast<uint8_t>(index), fms::Access::All, {}};
  }
  tl::expected<fms::Accessed, fms::ReturnCode> read(runtime::Time, uint16_t index) override {
    const auto object = find(index);
    if (!object) return tl::unexpected(fms::errors::kNoObject);
    return fms::Accessed{fms::Octets(std::min<size_t>(object->length, 230)), index % 3U};
  }
  tl::expected<fms::Accessed, fms::ReturnCode> write(runtime::Time, uint16_t index, std::span<const uint8_t> data) override {
    require(data.size() <= 241, "a write is no longer than its unit of data");
    if (!find(index)) return tl::unexpected(fms::errors::kNoObject);
    return fms::Accessed{{}, index % 3U};
  }
};

void check_octets(const fms::Octets& octets) {
  fms::describe(octets);
  const auto message = fms::decode(octets);
  if (!message) return;
  const auto again = fms::decode(fms::encode(*message));
  require(again && *again == *message, "what is understood comes back the same");
}

void check_links(Input input) {
  Objects objects;
  fms::Server server(objects, true);
  fms::SlaveLinks links(server);
  std::vector<fms::ClientLink> clients;
  for (const fms::Connection& connection : fms::connections()) clients.emplace_back(connection, master_entry(connection, 8));
  runtime::Time now = 0;
  while (!input.empty()) {
    now += input.u8() * runtime::kMillisecond;
    const auto which = static_cast<uint8_t>(input.u8() % clients.size());
    fms::ClientLink& client = clients[which];
    fms::Octets data;
    switch (input.u8() % 4) {
      case 0:
        client.ask({static_cast<fms::Service>(input.u8() % fms::service_types().size()), input.u16(), fms::Octets(input.u8())});
        continue;
      case 1:
        data.resize(input.u8() % 245U);
        for (uint8_t& octet : data) octet = input.u8();
        check_octets(data);
        if (input.u8() % 2 == 0) {  // a foreign slave
          client.answered(now, data);
          continue;
        }
        break;
      default: {
        const auto next = client.next(now);
        if (!next) continue;
        data = *next;
        if (input.u8() == 0 && !data.empty()) data[input.u8() % data.size()] = input.u8();
      }
    }
    const fms::LinkAnswer answer = links.take(now, client.connection().lsap, {2, which}, data);
    require(answer.data.size() <= 244, "an answer fits into its frame");
    check_octets(answer.data);
    if (!answer.refused) client.answered(now, answer.data);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  check_octets({data, data + size});
  check_links({data, size});
  return 0;
}
