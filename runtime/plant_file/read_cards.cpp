// `cards` of a [[station]]: which option cards are plugged into a MOVIDRIVE. Parameters of a card that is missing are refused
// (1053 1610 chapter 6.2, additional code 17h). Left out, all are there (ours).
#include <algorithm>

#include "runtime/plant_file/plant_reader.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::runtime {

namespace {

struct CardKey {
  std::string_view name;
  bool DriveOptions::*fitted;
};
constexpr CardKey kCards[] = {
    {"DRS", &DriveOptions::drs}, {"DIO", &DriveOptions::dio}, {"AIO", &DriveOptions::aio}};
constexpr std::string_view kCardNames = "cards is a list of DRS, DIO and AIO, those that are plugged in";

bool takes_cards(const stdlib::UnitType& unit) {
  const auto rows = stdlib::parameter_table(unit).by_index();
  return std::any_of(rows.begin(), rows.end(),
                     [](const stdlib::Parameter* row) { return row->option != stdlib::OptionCard::None; });
}

}  // namespace

void read_cards(PlantReader& reader, const toml::table& table, StationConfig& config) {
  const toml::node* node = table.get("cards");
  if (node == nullptr) return;
  if (config.unit != nullptr && !takes_cards(*config.unit))
    return reader.error(place_of(*node),
                        fmt::format("unit {} takes none of these option cards", config.unit->name));
  const toml::array* names = node->as_array();
  if (names == nullptr) return reader.error(place_of(*node), std::string(kCardNames));
  for (const CardKey& card : kCards) config.options.*card.fitted = false;
  for (const toml::node& name : *names) {
    const std::string text = name.value_or(std::string());
    const auto* card = std::find_if(std::begin(kCards), std::end(kCards),
                                    [&](const CardKey& one) { return one.name == text; });
    if (card == std::end(kCards))
      reader.error(place_of(name), std::string(kCardNames));
    else
      config.options.*card->fitted = true;
  }
}

}  // namespace ipos::runtime
