// The tab Parameters: the list of a unit in its groups, and what is read and written over the parameter channel of a
// station of the plant, as `ipos param` does it.
#include <fmt/format.h>

#include <algorithm>

#include "stdlib/parameters.hpp"
#include "tools/serve/parameter_rows.hpp"
#include "tools/serve/tabs.hpp"
#include "tools/unit/parameter_set.hpp"
#include "tools/unit/parameter_target.hpp"
#include "tools/unit/running_station.hpp"

namespace ipos::tools::serve {
namespace {

using stdlib::Service;

class ParameterTab final : public Tab {
 public:
  explicit ParameterTab(PlantHost& host) : host_(host) {
    Desk& desk = host.desk();
    desk.add_command("parameters", [this](const Desk::Call& call) {
      RunningStation access(station(call.arguments));
      return parameter_list(access);
    });
    desk.add_command("parameters.set", [this](const Desk::Call& call) { return set(call.arguments); });
    desk.add_command("parameters.compare", [this](const Desk::Call& call) {
      RunningStation one(station(call.arguments));
      RunningStation other(host_.station(call.arguments.text("with")));
      return compare(one, other);
    });
    desk.add_command("parameters.save", [this](const Desk::Call& call) {
      RunningStation access(station(call.arguments));
      bool complete = true;
      const ParameterSet settings = read_settings(access, complete);
      return Json{{"file", access.name() + ".settings"}, {"text", to_text(settings)}};
    });
    desk.add_command("parameters.load", [this](const Desk::Call& call) {
      host_.act("parameters.load",
                {{"station", call.arguments.text("station")}, {"text", call.arguments.text("text")}});
      return loaded_;
    });
    host.add_action("parameters.set", [this](const Json& action) {
      RunningStation access(station(Arguments(action)));
      write_parameter(access, action["index"].get<uint16_t>(), action["value"].get<int32_t>(),
                      action["volatile"].get<bool>());
    });
    host.add_action("parameters.load", [this](const Json& action) {
      RunningStation access(station(Arguments(action)));
      loaded_ = load_settings(access, action["text"].get<std::string>());
    });
    desk.add_topic("parameters",
                   [this](Client& client, Subscription& subscription) { publish(client, subscription); });
  }

 private:
  runtime::Station& station(const Arguments& a) const { return host_.station(a.text("station")); }

  Json set(const Arguments& a) {
    RunningStation access(station(a));
    const Target target = find_target(access.unit(), a.text("number"));
    const int32_t value = value_of(target, a.text("value"));
    host_.act("parameters.set", {{"station", a.text("station")},
                                 {"index", target.index},
                                 {"value", value},
                                 {"volatile", a.flag("volatile", false)}});
    const AccessReply now = access.execute(Service::Read, target.index, 0);
    return {{"text", text_of(target, now ? *now : value)}};
  }

  void publish(Client& client, Subscription& subscription) {
    const std::string name = Arguments(subscription.options).text("station", "");
    for (const auto& station : host_.plant().stations()) {
      if (station->config().name != name) continue;
      RunningStation access(*station);
      Json values = changed_values(access, subscription);
      if (values.empty() && !subscription.fresh) return;
      host_.desk().send(
          client,
          {{"event", "parameters"}, {"us", host_.us()}, {"station", name}, {"values", std::move(values)}});
    }
  }

  PlantHost& host_;
  Json loaded_;  // what came of the last file
};

}  // namespace

std::unique_ptr<Tab> make_parameter_tab(PlantHost& host) { return std::make_unique<ParameterTab>(host); }

}  // namespace ipos::tools::serve
