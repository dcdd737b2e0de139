// The journal of the plant as it grows.
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

constexpr size_t kAtOnce = 500;

const char* weight_text(runtime::Weight weight) {
  switch (weight) {
    case runtime::Weight::Why: return "why";
    case runtime::Weight::Warning: return "warning";
    case runtime::Weight::Fault: break;
  }
  return "fault";
}

class JournalTab final : public Tab {
 public:
  explicit JournalTab(PlantHost& host) {
    host.router().add_topic("journal", [&host](Client& client, Subscription& subscription) {
      const auto& entries = host.plant().journal().entries();
      if (!subscription.fresh && subscription.mark >= entries.size()) return;
      Json list = Json::array();
      for (; subscription.mark < entries.size() && list.size() < kAtOnce; ++subscription.mark) {
        const runtime::JournalEntry& entry = entries[static_cast<size_t>(subscription.mark)];
        list.push_back({{"n", subscription.mark + 1},
                        {"us", entry.time / runtime::kMicrosecond},
                        {"station", entry.station},
                        {"weight", weight_text(entry.weight)},
                        {"text", entry.text}});
      }
      host.router().send(client, {{"event", "journal"}, {"entries", std::move(list)}});
    });
  }
};

}  // namespace

std::unique_ptr<Tab> make_journal_tab(PlantHost& host) { return std::make_unique<JournalTab>(host); }

}  // namespace ipos::tools::serve
