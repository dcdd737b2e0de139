// The commands and the topic; a unit that takes its time for each answer is asked for a few values at a time.
#include "tools/serve/host/parameter_tab.hpp"

#include "stdlib/parameters.hpp"
#include "tools/parameters/parameter_set.hpp"
#include "tools/parameters/parameter_target.hpp"
#include "tools/serve/host/parameter_files.hpp"
#include "tools/serve/host/parameter_rows.hpp"

namespace ipos::tools::serve {
namespace {

using stdlib::Parameter;
using stdlib::Service;

constexpr const char* kStation = "station";

// What a unit refuses to read is left out.
ParameterSet settings_of(ParameterAccess& unit) {
  bool complete = true;
  return read_settings(unit, complete);
}

// The list without the unit: what its table knows.
class TableAccess final : public ParameterAccess {
 public:
  explicit TableAccess(const ParameterAccess& of) : of_(of) {}
  AccessReply execute(Service service, uint16_t index, int32_t) override {
    if (service != Service::ReadMinimum && service != Service::ReadMaximum)
      return tl::unexpected(AccessError{{}, "not asked yet"});
    const Parameter* parameter = stdlib::parameter_table(unit()).find(index);
    const int64_t limit = service == Service::ReadMinimum ? parameter->minimum() : parameter->maximum();
    return static_cast<int32_t>(static_cast<uint32_t>(limit));
  }
  std::string name() const override { return of_.name(); }
  const stdlib::UnitType& unit() const override { return of_.unit(); }

 private:
  const ParameterAccess& of_;
};

}  // namespace

ParameterTab::ParameterTab(Router& router, ParameterSource& source) : router_(router), source_(source) {
  router.add_command("parameters", [this](const Router::Call& call) { return list(call); });
  router.add_command("parameters.set", [this](const Router::Call& call) { return set(call); });
  router.add_command("parameters.compare", [this](const Router::Call& call) { return compare(call); });
  router.add_command("parameters.save", [this](const Router::Call& call) { return save(call); });
  router.add_command("parameters.toml", [this](const Router::Call& call) { return toml(call); });
  router.add_command("parameters.load", [this](const Router::Call& call) { return load(call); });
  router.add_topic("parameters",
                   [this](Client& client, Subscription& subscription) { publish(client, subscription); });
}

Json ParameterTab::list(const Router::Call& call) {
  const auto unit = source_.unit(call.arguments, kStation);
  if (source_.answers_at_once()) return parameter_list(*unit);
  TableAccess table(*unit);
  return parameter_list(table);
}

Json ParameterTab::set(const Router::Call& call) {
  source_.check_writing(call);
  const auto unit = source_.unit(call.arguments, kStation);
  const Target target = find_target(unit->unit(), call.arguments.text("number"));
  const int32_t value = value_of(target, call.arguments.text("value"));
  Json order{{"index", target.index}, {"value", value}, {"volatile", call.arguments.flag("volatile", false)}};
  order[kStation] = source_.station(call.arguments);
  source_.write(order);
  if (!source_.answers_at_once()) return {{"text", text_of(target, value)}};
  const AccessReply now = unit->execute(Service::Read, target.index, 0);
  return {{"text", text_of(target, now ? *now : value)}};
}

Json ParameterTab::compare(const Router::Call& call) {
  source_.check_reading();
  const auto one = source_.unit(call.arguments, kStation);
  const ParameterSet own = settings_of(*one);
  if (call.arguments.has("text"))
    return serve::compare(own, settings_in(call.arguments.text("text"), source_.station(call.arguments), one->unit()));
  return serve::compare(own, settings_of(*source_.unit(call.arguments, "with")));
}

Json ParameterTab::save(const Router::Call& call) {
  source_.check_reading();
  const auto unit = source_.unit(call.arguments, kStation);
  return {{"file", source_.station(call.arguments) + ".settings"}, {"text", to_text(settings_of(*unit))}};
}

Json ParameterTab::toml(const Router::Call& call) {
  source_.check_reading();
  const auto unit = source_.unit(call.arguments, kStation);
  return {{"file", source_.station(call.arguments) + ".toml"}, {"text", plant_lines(settings_of(*unit))}};
}

Json ParameterTab::load(const Router::Call& call) {
  source_.check_writing(call);
  return source_.write_file(
      {{kStation, source_.station(call.arguments)}, {"text", call.arguments.text("text")}});
}

void ParameterTab::publish(Client& client, Subscription& subscription) {
  std::shared_ptr<ParameterAccess> unit;
  try {
    unit = source_.unit(Arguments(subscription.options), kStation);
  } catch (const Mistake&) {  // it was subscribed without one
    return;
  }
  const auto rows = stdlib::parameter_table(unit->unit()).by_index();
  const size_t at_once = source_.answers_at_once() ? rows.size() : kReadsAtOnce;
  Json values = Json::object();
  for (size_t n = 0; n < at_once && !rows.empty() && !source_.others_wait(); ++n) {
    const Parameter& parameter = *rows[subscription.mark++ % rows.size()];
    const AccessReply value = unit->execute(Service::Read, parameter.index, 0);
    const std::string index = std::to_string(parameter.index);
    if (value && subscription.is_news(index, *value)) values[index] = value_json(parameter, *value);
  }
  if (values.empty() && !(subscription.fresh && source_.answers_at_once())) return;
  router_.send(client, {{"event", "parameters"},
                        {"us", source_.us()},
                        {"station", source_.station(Arguments(subscription.options))},
                        {"values", std::move(values)}});
}

}  // namespace ipos::tools::serve
