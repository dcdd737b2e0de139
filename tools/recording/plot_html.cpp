// The page is the second bundle of web/ (web/src/picture/plot_page.ts); its data are JSON in place of @DATA@.
#include "tools/recording/plot_html.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "stdlib/embedded.hpp"
#include "tools/recording/channel_json.hpp"

namespace ipos::tools {
namespace plot_page {
std::span<const stdlib::EmbeddedFile> embedded_files();
}

namespace {

using nlohmann::json;

double milliseconds(runtime::Time time) { return static_cast<double>(time) / 1e6; }

// Number of the sample, value; only where it changes.
json changes_of(const Signal& signal, const std::vector<int64_t>& samples) {
  json changes = json::array();
  for (size_t n = 0; n < samples.size(); ++n) {
    if (n != 0 && samples[n] == samples[n - 1]) continue;
    changes.push_back(n);
    if (signal.factor == 1)
      changes.push_back(samples[n]);
    else
      changes.push_back(static_cast<double>(samples[n]) * signal.factor);
  }
  return changes;
}

}  // namespace

std::string plot_html(const Recording& recording, const std::string& title) {
  std::vector<json> channels;
  for (const Signal& signal : recording.signals) channels.push_back(channel_json(signal));
  return plot_html_of(recording, channels, title);
}

std::string plot_html_of(const Recording& recording, const std::vector<json>& channels, const std::string& title) {
  json data;
  data["title"] = title;
  data["begin"] = recording.times.empty() ? 1 : milliseconds(recording.times.front());
  data["end"] = recording.times.empty() ? 0 : milliseconds(recording.times.back());
  data["samples"] = recording.times.size();
  data["signals"] = json::array();
  for (size_t n = 0; n < recording.signals.size(); ++n) {
    const Signal& signal = recording.signals[n];
    json row = channels[n];
    row["status"] = signal.is_status;
    row["binary"] = is_binary(recording, n);
    row["changes"] = changes_of(signal, recording.samples[n]);
    data["signals"].push_back(std::move(row));
  }
  data["events"] = json::array();
  for (const RecordedEvent& event : recording.events)
    data["events"].push_back(
        {{"time", milliseconds(event.time)}, {"text", event.text}, {"fault", event.is_fault}});
  data["tracks"] = json::array();
  for (size_t n = 0; n < recording.tracks.size(); ++n) {
    json times = json::array();
    for (const RecordedFrame& frame : recording.frames)
      if (frame.track == n) times.push_back(milliseconds(frame.time));
    data["tracks"].push_back({{"name", recording.tracks[n].bus + ".frames"}, {"times", std::move(times)}});
  }
  std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  // Nothing in the data ends the script that holds them.
  for (size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at))
    text.replace(at, 2, "<\\/");
  constexpr std::string_view kPlace = "@DATA@";
  std::string page(plot_page::embedded_files().front().text);
  return page.replace(page.find(kPlace), kPlace.size(), text);
}

}  // namespace ipos::tools
