// ipos campaign show: the command that runs one case again, or the page with it.
#include <fmt/format.h>

#include "tools/campaign/campaign_verbs.hpp"
#include "tools/campaign/case_files.hpp"
#include "tools/cli/exit_codes.hpp"

namespace ipos::tools::campaign {
namespace {

struct ShowFlags : CampaignFlags {
  std::string name;
  bool serve = false;
  bool plant = false;
  uint16_t port = 0;
};

int show(const ShowFlags& flags) {
  const Campaign campaign = read_campaign(flags.file, flags.compile);
  const Levels levels = find_case(campaign.outline, flags.name);
  if (flags.plant) {
    fmt::print("{}", Subject(campaign, flags.compile).plant_text(levels));
    return kGood;
  }
  if (flags.serve) return serve_case(campaign, flags.compile, levels, flags.port);
  fmt::print("{}\n", command_of(flags.file, campaign.outline.case_of(levels)));
  return kGood;
}

}  // namespace

void add_show(cli::Verb& parent) {
  auto flags = std::make_shared<ShowFlags>();
  cli::Verb& verb = parent.verb("show", "print the command that runs one case again");
  add_campaign_options(verb, *flags);
  verb.option("CASE", flags->name, "its name in the results, or the beginning of it").required();
  verb.flag("--serve", flags->serve, "open the case in the page of ipos serve");
  verb.option("--port", flags->port, "of that page; default: a free one");
  verb.flag("--plant", flags->plant, "print the plant file of the case");
  verb.footer("Example:\n  ipos campaign show examples/campaign/line.campaign.toml 0123456789abcdef");
  verb.runs([flags] { return show(*flags); });
}

}  // namespace ipos::tools::campaign
