// From an input of the first station to the telegram as in its reaction; then each object: the tick of its receiver, the turns that its
// program takes from its variables to those that go on, a period until they are sampled, for they were due just before, and the line;
// at the end the turns from the last object to an output.
#include "tools/bus/reaction_chains.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::tools {
namespace {

using runtime::kMillisecond;
using runtime::Time;

class Search {
 public:
  explicit Search(const std::vector<Reaction>& reactions) : reactions_(reactions) {}

  ReactionChains run() {
    for (size_t n = 0; n < reactions_.size(); ++n) {
      path_ = {n};
      go_on();
    }
    return std::move(found_);
  }

 private:
  bool stands_before(const std::string& station) const {
    return std::any_of(path_.begin(), path_.end(), [&](size_t hop) { return reactions_[hop].sender == station; });
  }

  void go_on() {
    if (path_.size() == kMostHops) return;
    for (const auto& [n, turns] : reactions_[path_.back()].onward) {
      if (!turns.depends && turns.because.empty()) continue;
      const bool round = stands_before(reactions_[n].receiver);
      path_.push_back(n);
      if (found_.all.size() < kMostChains)
        found_.all.push_back(of_path(round));
      else
        ++found_.left_out;
      if (!round && found_.left_out == 0) go_on();
      path_.pop_back();
    }
  }

  ReactionChain of_path(bool round) const {
    ReactionChain chain{path_, {}, {}, round};
    Time time = 0;
    const auto add = [&](const ProgramTurns& turns) {
      if (chain.because.empty()) chain.because = turns.because;
      time += static_cast<Time>(turns.ms) * kMillisecond;
    };
    add(reactions_[path_.front()].sent);
    for (size_t n = 0; n < path_.size(); ++n) {
      const Reaction& hop = reactions_[path_[n]];
      for (const std::string* reason : {&hop.line_because, &hop.cycle_because})
        if (chain.because.empty()) chain.because = *reason;
      time += hop.period + hop.response;
      if (n + 1 == path_.size()) break;
      add(hop.onward.at(path_[n + 1]));
      time += kMillisecond;
    }
    add(reactions_[path_.back()].received);
    if (chain.because.empty()) chain.from_input = time;
    return chain;
  }

  const std::vector<Reaction>& reactions_;
  std::vector<size_t> path_;
  ReactionChains found_;
};

}  // namespace

ReactionChains reaction_chains(const std::vector<Reaction>& reactions) { return Search(reactions).run(); }

std::string chains_text(const ReactionChains& chains, const std::vector<Reaction>& reactions) {
  if (chains.all.empty()) return {};
  std::string text = "reactions over several stations, worst case\n";
  for (const ReactionChain& chain : chains.all) {
    text += fmt::format("  input of {}", reactions[chain.hops.front()].sender);
    for (const size_t hop : chain.hops)
      text += fmt::format(", object {} on {} to {}", runtime::object_words(static_cast<int32_t>(reactions[hop].object)), reactions[hop].line,
                          reactions[hop].receiver);
    text += fmt::format(", output of {}: ", reactions[chain.hops.back()].receiver);
    text += chain.from_input ? fmt::format("{}.{:03} ms", *chain.from_input / kMillisecond, *chain.from_input % kMillisecond / runtime::kMicrosecond)
                             : "unbounded: " + chain.because;
    if (chain.is_round) text += "; it is a round, and what goes on in it takes as long again each time";
    text += "\n";
  }
  if (chains.left_out != 0) text += fmt::format("  {} chains are listed, and there are more\n", kMostChains);
  return text + "\n";
}

}  // namespace ipos::tools
