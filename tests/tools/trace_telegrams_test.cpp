// Telegrams in a trace are those that the decoder reads in the log of the same run: in each millisecond a signal has what
// the last telegram before its end carried.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using nlohmann::json;

struct Telegram {
  double end_ms;
  json fields;  // of `ipos bus decode --format json`
};

struct TracedRun {
  std::vector<std::string> names;          // without "time_ms"
  std::vector<std::vector<int64_t>> rows;  // one a millisecond, from 1 ms on
  std::vector<Telegram> telegrams;
};

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

TracedRun traced_run(const std::string& plant, const std::string& span, const std::string& signals) {
  const TemporaryFolder folder;
  run_ipos({"run", (project("examples") / plant).string(), "--for", span, "--trace", "t.csv", "--signals",
            signals, "--serial-log", "s.log"},
           folder.path());
  TracedRun out;
  const std::vector<std::string> table = split(read_text(folder.path() / "t.csv"), '\n');
  for (size_t n = 0; n < table.size(); ++n) {
    std::vector<std::string> cells = split(table[n], ',');
    cells.erase(cells.begin());
    if (n == 0)
      out.names = cells;
    else
      std::transform(cells.begin(), cells.end(), std::back_inserter(out.rows.emplace_back()),
                     [](const std::string& cell) { return std::stoll(cell); });
  }
  const std::vector<std::string> log = split(read_text(folder.path() / "s.log"), '\n');
  const std::vector<std::string> decoded =
      split(run_ipos({"bus", "decode", "s.log", "--format", "json"}, folder.path()).out, '\n');
  EXPECT_EQ(log.size(), decoded.size());
  for (size_t n = 0; n < std::min(log.size(), decoded.size()); ++n)
    out.telegrams.push_back({std::stod(split(log[n], ' ')[1]) * 1000, json::parse(decoded[n])});
  return out;
}

// `note(telegram, said)` writes into `said` what a telegram says of the signals; the others stay as they were.
template <typename Note>
size_t compare(const TracedRun& run, Note note) {
  std::map<std::string, int64_t> said;
  size_t next = 0, differ = 0;
  for (size_t n = 0; n < run.rows.size(); ++n) {
    for (; next < run.telegrams.size() && run.telegrams[next].end_ms <= static_cast<double>(n + 1); ++next)
      note(run.telegrams[next].fields, said);
    for (size_t column = 0; column < run.names.size(); ++column)
      if (run.rows[n][column] != said[run.names[column]] && differ++ < 5)
        ADD_FAILURE() << run.names[column] << " at " << n + 1 << " ms: " << run.rows[n][column]
                      << ", the decoder says " << said[run.names[column]];
  }
  EXPECT_GT(next, 0U);
  for (const std::string& name : run.names) EXPECT_NE(said[name], 0) << name << " is never told of";
  return next;
}

TEST(TraceTelegrams, Rs485AsDecoded) {
  const TracedRun rs485 = traced_run(
      "movilink-rs485/rs485.toml", "1s",
      "line1.1.PO1,line1.1.PO2,line1.1.PO3,line1.1.PI1,line1.1.request_service,line1.1.request_index,"
      "line1.1.answer_index,line1.1.answer_value,line1.1.requests,line1.1.answers");
  ASSERT_EQ(rs485.names.size(), 10U);
  ASSERT_EQ(rs485.rows.size(), 1000U);
  compare(rs485, [](const json& telegram, std::map<std::string, int64_t>& said) {
    if (telegram.contains("void")) return;  // cut off by the end of the run
    const std::string unit = "line1." + std::to_string(telegram.at("address").get<int>()) + ".";
    const bool answer = telegram.at("response").get<bool>();
    ++said[unit + (answer ? "answers" : "requests")];
    const std::string word = unit + (answer ? "PI" : "PO");
    if (const auto words = telegram.find(answer ? "pi" : "po"); words != telegram.end())
      for (size_t n = 0; n < words->size(); ++n)
        said[word + std::to_string(n + 1)] = words->at(n).get<int64_t>();
    for (const std::string field : {"service", "index", "value"})
      if (const auto number = telegram.find(field); number != telegram.end())
        said[unit + (answer ? "answer_" : "request_") + field] = number->get<int64_t>();
  });
}

// What Data_Exchange carries stands behind the colon; address 8 has the parameter channel before its words, 9 has not.
TEST(TraceTelegrams, ProfibusAsDecoded) {
  const TracedRun profibus =
      traced_run("profibus/profibus.toml", "2s",
                 "dp.8.PO1,dp.8.PO2,dp.8.PI1,dp.8.PI2,dp.8.request_index,dp.8.answer_index,dp.8."
                 "answer_value,dp.8.ident,dp.9.PO1,"
                 "dp.9.PO2,dp.9.PI1,dp.9.ident");
  ASSERT_EQ(profibus.names.size(), 12U);
  ASSERT_EQ(profibus.rows.size(), 2000U);
  compare(profibus, [](const json& telegram, std::map<std::string, int64_t>& said) {
    const std::string text = telegram.value("text", "");
    std::smatch found;
    if (std::regex_search(text, found, std::regex(R"(^(\d+) -> 1 Slave_Diag answer.* ident ([0-9A-F]{4})h)")))
      said["dp." + found[1].str() + ".ident"] = std::stoll(found[2], nullptr, 16);
    if (!std::regex_search(text, found,
                           std::regex(R"(^(\d+) -> (\d+) Data_Exchange( answer)?,.*: ([0-9A-F ]+)$)")))
      return;
    const bool answer = found[3].matched;
    const std::string address = answer ? found[1] : found[2], unit = "dp." + address + ".";
    std::vector<int64_t> octets;
    for (const std::string& octet : split(found[4], ' ')) octets.push_back(std::stoll(octet, nullptr, 16));
    const auto number = [&octets](size_t at) { return octets[at] << 8 | octets[at + 1]; };
    const size_t channel = address == "8" ? 8 : 0;
    if (channel != 0) {
      said[unit + (answer ? "answer_index" : "request_index")] = number(2);
      said[unit + (answer ? "answer_value" : "request_value")] = number(4) << 16 | number(6);
    }
    for (size_t at = channel; at + 1 < octets.size(); at += 2)
      said[unit + (answer ? "PI" : "PO") + std::to_string((at - channel) / 2 + 1)] = number(at);
  });
}

TEST(TraceTelegrams, TheListHasThem) {
  const CommandResult rs485 =
      run_ipos({"run", project("examples/movilink-rs485/rs485.toml").string(), "--signals", "list"});
  for (const char* name : {"line1.1.PO1", "line1.1.PI3", "line1.1.answer_value"})
    EXPECT_NE(rs485.out.find(name), std::string::npos) << rs485.out;
  const CommandResult profibus =
      run_ipos({"run", project("examples/profibus/profibus.toml").string(), "--signals", "list"});
  for (const char* name : {"dp.8.PO3", "dp.8.request_index", "dp.9.PI2", "dp.9.ident", "dp.127.command"})
    EXPECT_NE(profibus.out.find(name), std::string::npos) << profibus.out;
}

}  // namespace
}  // namespace ipos::tests
