// The signs of the kinds, in the order in which they count, and what is told of each kind.
#include "runtime/plant_file/toml_sign.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {
namespace {

std::optional<FilePlace> first_of(const toml::table& root, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys)
    if (const toml::node* node = root.get(key)) return place_of(*node);
  return std::nullopt;
}

std::string what_it_is(TomlKind kind, const toml::table& root) {
  switch (kind) {
    case TomlKind::Plant: return "this is a plant: `ipos run` runs it, and a test or a campaign names it with plant = \"...\"";
    case TomlKind::Campaign: return "this is a campaign: `ipos campaign run FILE --out DIR` runs its cases, `ipos campaign plan FILE` counts them";
    case TomlKind::Parameters: return "this is a set of parameters: `ipos param load` writes it into a unit";
    case TomlKind::Test:
    case TomlKind::Unknown: break;
  }
  const std::string named = root["plant"].value_or(std::string());
  if (named.empty()) return "this is a test: `ipos test` carries out what stands here";
  return fmt::format("this is a test of the plant '{}': `ipos test` and `ipos debug` carry it out, other verbs take the plant", named);
}

}  // namespace

bool named_test(std::string_view path) { return path.ends_with(".test.toml"); }
bool named_campaign(std::string_view path) { return path.ends_with(".campaign.toml"); }

TomlSign kind_of_toml(const toml::table& root, std::string_view path) {
  if (const auto place = first_of(root, {kParameterSetKey})) return {TomlKind::Parameters, *place};
  // Keys that only a campaign has, and that nobody writes into another file by mistake.
  if (const auto place = first_of(root, {"tests", "vary", "measure", "sample"})) return {TomlKind::Campaign, *place};
  const auto plant = first_of(root, {"plant"});
  // Keys that only a test has; the expectations of a plant stand beside its stations.
  if (const auto place = first_of(root, {"plant_expects", "by_hand", "speed", "step", "case"})) return {TomlKind::Test, plant.value_or(*place)};
  if (root.contains("station") || root.contains("bus")) return {TomlKind::Plant, {1, 1}};
  if (plant && root.contains("expect")) return {TomlKind::Test, *plant};
  if (const auto place = first_of(root, {"for", "limit", "count", "seed"})) return {TomlKind::Campaign, *place};
  if (!plant) return {named_test(path) ? TomlKind::Test : TomlKind::Unknown, {1, 1}};
  // A plant and its faults are a campaign, as those of a test stand in its plant. A plant alone may be either.
  const bool campaign = named_campaign(path) || (root.contains("fault") && !named_test(path));
  return {campaign ? TomlKind::Campaign : TomlKind::Test, *plant};
}

TomlKind kind_of_text(std::string_view text, std::string_view path) {
  if (const auto root = read_toml(text)) return kind_of_toml(*root, path).kind;
  return named_test(path) ? TomlKind::Test : named_campaign(path) ? TomlKind::Campaign : TomlKind::Unknown;
}

std::optional<TomlError> wrong_kind(const toml::table& root, std::string_view path, std::initializer_list<TomlKind> taken) {
  const TomlSign sign = kind_of_toml(root, path);
  if (sign.kind == TomlKind::Unknown || std::find(taken.begin(), taken.end(), sign.kind) != taken.end()) return std::nullopt;
  return TomlError{sign.place, what_it_is(sign.kind, root)};
}

}  // namespace ipos::runtime
