// ipos campaign: many runs of a plant or of tests with other values, and what came of them.
#include <fmt/format.h>

#include <cmath>

#include "tools/campaign/campaign_verbs.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/verbs.hpp"

namespace ipos::tools {
namespace campaign {
namespace {

// As a shell takes it.
std::string in_shell(const std::string& text) {
  const bool plain = !text.empty() && text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./-=+,:@%") == std::string::npos;
  if (plain) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

}  // namespace

void add_campaign_options(cli::Verb& verb, CampaignFlags& flags) {
  verb.option("FILE", flags.file, "NAME.campaign.toml").required();
  add_plant_options(verb, flags.compile);
}

std::string duration_text(double seconds) {
  if (seconds < 60) return fmt::format("{:.{}f} s", seconds, seconds < 10 ? 1 : 0);
  const auto whole = static_cast<uint64_t>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

std::string command_of(const std::string& file, uint64_t id) {
  return fmt::format("ipos campaign run {} --case {}", in_shell(file), hex(id));
}

std::string command_of(const std::string& file, const Outline& outline, const Levels& levels) {
  std::string command = fmt::format("ipos campaign run {}", in_shell(file));
  for (size_t n = 0; n < levels.size(); ++n)
    if (const FactorOutline& factor = outline.factors[n]; levels[n] != factor.middle())
      command += " --factor " + in_shell(fmt::format("{}={}", factor.name, factor.levels[levels[n]].text));
  return command == fmt::format("ipos campaign run {}", in_shell(file)) ? command + " --middle" : command;
}

Levels find_case(const Outline& outline, const std::string& name) {
  const Plan plan(outline);
  Levels levels;
  uint64_t found = 0;
  for (uint64_t rank = 0; rank < plan.size(); ++rank)
    if (hex(plan.case_at(rank)).starts_with(name) && ++found == 1) plan.levels(rank, levels);
  if (found == 1) return levels;
  throw Failure(kNoInput, found == 0 ? fmt::format("{}: there is no case {} in this plan of {} cases", outline.campaign, name, plan.size())
                                     : fmt::format("{}: {} cases begin with {}", outline.campaign, found, name));
}

}  // namespace campaign

void add_campaign(cli::Verb& app) {
  cli::Verb& verb = app.verb("campaign", "run a plant or tests with many values, on all cores or machines");
  campaign::add_plan(verb);
  campaign::add_run(verb);
  campaign::add_merge(verb);
  campaign::add_show(verb);
  verb.footer("Example:\n  ipos campaign run examples/campaign/line.campaign.toml --out results");
}

}  // namespace ipos::tools
