// Each further object adds at its worst: a period until it is sampled, for it was due just before the write; then its line, the tick
// of the receiver and two turns, which is the reaction from its telegram. A program that reads in one task and writes in another one
// adds two turns of the latter. What the reaction before counts to the terminal of an output is no less than to the write of a variable.
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
    const Reaction& last = reactions_[path_.back()];
    if (path_.size() == kMostHops || last.receiver_task == 0) return;
    for (size_t n = 0; n < reactions_.size(); ++n) {
      const Reaction& next = reactions_[n];
      if (next.sender != last.receiver || next.sender_task == 0) continue;
      const bool round = stands_before(next.receiver);
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
    const Reaction& first = reactions_[path_.front()];
    std::optional<Time> time = first.from_input;
    chain.because = first.because;
    for (size_t n = 1; n < path_.size(); ++n) {
      const Reaction &before = reactions_[path_[n - 1]], &next = reactions_[path_[n]];
      if (!next.from_input && chain.because.empty()) chain.because = next.because;
      if (!time || !next.from_input) {
        time.reset();
        continue;
      }
      *time += next.period + *next.from_telegram;
      if (next.sender_task != before.receiver_task) *time += static_cast<Time>(2 * next.sender_turn) * kMillisecond;
    }
    chain.from_input = time;
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
  std::string text = "reactions over several stations, worst case, of what each program does within one turn of its loop\n";
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
