// Moments of a plant that the debugger can go on from, where there is a way to keep one. Where there is none time goes
// back by running again from the beginning.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "tools/debugger/position.hpp"

namespace ipos::tools::debug {

class Snapshots {
 public:
  virtual ~Snapshots() = default;

  // A snapshot of now. Nothing is returned to whom it takes; bytes are, at a later time, to the one that goes
  // on from here.
  virtual std::optional<std::string> take(const Position& now) = 0;

  // The last one at or before a position, or strictly before it.
  virtual const Position* before(const Position& position, bool strictly) const = 0;
  // The last one at or before a time.
  virtual const Position* before(runtime::Time time) const = 0;
  // Goes on from that one, and all others stay, later ones, too; returns only if it is gone.
  virtual void go_on_from(const Position& snapshot, const std::string& bytes) = 0;

  // Those after a position belong to what does not come any more.
  virtual void drop_after(const Position& position) = 0;
  virtual size_t count() const = 0;
  virtual void clear() = 0;
  // Memory of all snapshots: their share of all pages, and what each has for itself, in KiB.
  struct Memory {
    size_t shared_out = 0;
    size_t own = 0;
  };
  virtual Memory memory() const = 0;
};

}  // namespace ipos::tools::debug
