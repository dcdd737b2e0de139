// The units of a plant for the tab Parameters: what is written is done again when its time comes again.
#include "tools/parameters/running_station.hpp"
#include "tools/serve/host/parameter_rows.hpp"
#include "tools/serve/host/parameter_tab.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

class PlantParameters final : public Tab, private ParameterSource {
 public:
  explicit PlantParameters(PlantHost& host) : host_(host), tab_(host.router(), *this) {
    host.add_action("parameters.set", [this](const Json& action) {
      write_parameter(*unit(Arguments(action), "station"), action["index"].get<uint16_t>(),
                      action["value"].get<int32_t>(), action["volatile"].get<bool>());
    });
    host.add_action("parameters.load", [this](const Json& action) {
      loaded_ = load_settings(*unit(Arguments(action), "station"), action["text"].get<std::string>());
    });
  }

 private:
  std::shared_ptr<ParameterAccess> unit(const Arguments& a, const char* key) override {
    return std::make_shared<RunningStation>(host_.station(a.text(key)));
  }
  bool answers_at_once() const override { return true; }
  void write(const Json& order) override { host_.act("parameters.set", order); }
  Json write_file(const Json& order) override {
    host_.act("parameters.load", order);
    return loaded_;
  }
  int64_t us() const override { return host_.us(); }

  PlantHost& host_;
  Json loaded_;  // what came of the last file
  ParameterTab tab_;
};

}  // namespace

std::unique_ptr<Tab> make_parameter_tab(PlantHost& host) { return std::make_unique<PlantParameters>(host); }

}  // namespace ipos::tools::serve
