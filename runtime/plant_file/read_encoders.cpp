// [station.encoders] of the plant file: the shafts of other stations on the encoder sockets of this one.
#include "runtime/plant_file/plant_reader.hpp"
#include "stdlib/unit_names.hpp"

namespace ipos::runtime {
namespace {

// X14 is there where positions are (H510), X42 where the card for synchronous operation fits.
stdlib::Trait needed_for(EncoderSocket socket) {
  return socket == EncoderSocket::X14 ? stdlib::Trait::Positioning : stdlib::Trait::OptionCards;
}

void read_encoder(PlantReader& reader, const toml::table& encoders, EncoderSocket socket, StationConfig& config) {
  const std::string_view key = kEncoderSockets[static_cast<size_t>(socket)];
  const toml::node* node = encoders.get(key);
  if (node == nullptr) return;
  const FilePlace place = place_of(*node);
  std::string shaft = reader.text(encoders, key, "", false);
  if (shaft.empty()) return;
  if (shaft == config.name)
    return reader.error(place, fmt::format("{} takes the shaft of another station; left out, X14 follows the own one", key));
  if (config.unit != nullptr && !config.unit->has(needed_for(socket)))
    return reader.error(place, fmt::format("{} is of {}; unit {} has no such socket", key,
                                           stdlib::unit_names(needed_for(socket)), config.unit->name));
  if (socket == EncoderSocket::X42 && !config.options.drs)
    return reader.error(place, fmt::format("{} is of the card DRS, which cards does not name", key));
  reader.use_station(shaft, place);
  if (socket == EncoderSocket::X42) config.options.master_encoder = true;
  config.encoders.push_back({socket, std::move(shaft), place});
}

}  // namespace

void read_encoders(PlantReader& reader, const toml::table& station, StationConfig& config) {
  const toml::table* encoders = reader.subtable(station, "encoders");
  if (encoders == nullptr) return;
  reader.known_keys(*encoders, "[station.encoders]", {kEncoderSockets.begin(), kEncoderSockets.end()});
  for (size_t n = 0; n < kEncoderSockets.size(); ++n)
    read_encoder(reader, *encoders, static_cast<EncoderSocket>(n), config);
}

}  // namespace ipos::runtime
