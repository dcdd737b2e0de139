// Reactions that go on from station to station: who receives an object sends another one, to an output of the last of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/bus/reaction.hpp"

namespace ipos::tools {

struct ReactionChain {
  std::vector<size_t> hops;  // numbers of reactions, two or more; the receiver of each is the sender of the next
  std::optional<runtime::Time> from_input;  // none: `because`
  std::string because;
  bool is_round = false;  // the last receiver stands in the chain before: what goes round again takes as long again
};

struct ReactionChains {
  std::vector<ReactionChain> all;
  size_t left_out = 0;  // beyond what is listed
};

// Of stations whose program reads what the one before sends, and writes what it sends to the next. No station twice, except as
// the end of a round; at most kMostHops objects, and kMostChains of them (ours).
inline constexpr size_t kMostHops = 8;
inline constexpr size_t kMostChains = 64;
ReactionChains reaction_chains(const std::vector<Reaction>& reactions);

std::string chains_text(const ReactionChains& chains, const std::vector<Reaction>& reactions);

}  // namespace ipos::tools
