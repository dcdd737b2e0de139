// The kinds of expectations.
#include "tools/testing/check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/testing/pattern.hpp"

namespace ipos::tools::testing {

Check::Check(const Expect& expect, Time start) : expect_(expect), start_(start), end_(runtime::kNever) {
  if (const auto span = expect.within ? expect.within : expect.during) end_ = start + *span;
  // Values are looked at once a millisecond.
  constexpr Time kTick = runtime::kMillisecond;
  if (expect.kind == Expect::Kind::Now) end_ = (start + kTick - 1) / kTick * kTick;
}

void Check::fail(std::string problem) {
  verdict_ = Verdict::Failed;
  problem_ = std::move(problem);
}

size_t Check::length() const {
  return expect_.subject.is_event() ? expect_.patterns.size() : expect_.values.size();
}

std::string Check::wanted() const {
  return expect_.subject.is_event() ? expect_.patterns[next_] : expect_.subject.value_text(expect_.values[next_]);
}

void Check::sample(Time now, int64_t value) {
  if (verdict_ != Verdict::Open || now < start_ || now > end_) return;
  const std::string name = expect_.subject.text();
  const auto is = [&] { return expect_.subject.value_text(value); };
  const bool first = !last_value_;
  const bool changed = first || value != *last_value_;
  last_value_ = value;
  ++seen_;
  if (expect_.kind == Expect::Kind::Sequence) {
    if (changed)
      element(now, value == expect_.values[next_], fmt::format("{} became {}", name, is()), first);
    return;
  }
  const bool holds = expect_.condition.holds(value);
  switch (expect_.kind) {
    case Expect::Kind::Now:
      if (holds) return meet();
      return fail(
          fmt::format("{} is {} at {}, expected {}", name, is(), time_text(now), expect_.condition.text(expect_.subject)));
    case Expect::Kind::Always:
      if (!holds)
        fail(fmt::format("{} is {} at {}, expected always {}", name, is(), time_text(now),
                         expect_.condition.text(expect_.subject)));
      break;
    case Expect::Kind::Never:
      if (holds)
        fail(fmt::format("{} is {} at {}, expected never {}", name, is(), time_text(now),
                         expect_.condition.text(expect_.subject)));
      break;
    default:
      // What is so from the beginning has not become so.
      if (holds && !held_ && (!first || expect_.kind == Expect::Kind::Within)) occur(now);
  }
  held_ = holds;
}

void Check::event(Time now, const std::string& text, const std::string& meaning) {
  if (verdict_ != Verdict::Open || now <= start_ || now > end_) return;
  const auto fits = [&](const std::string& pattern) {
    return matches(pattern, text) || (!meaning.empty() && matches(pattern, meaning));
  };
  const bool matched = fits(expect_.subject.pattern);
  const std::string shown = meaning.empty() ? text : fmt::format("{} ({})", text, meaning);
  ++seen_;
  switch (expect_.kind) {
    case Expect::Kind::Always:
      if (!matched)
        fail(fmt::format("{} came on {} at {}, expected only {}", shown, expect_.subject.bus, time_text(now),
                         expect_.subject.pattern));
      break;
    case Expect::Kind::Never:
      if (matched)
        fail(fmt::format("{} came on {} at {}, expected never", shown, expect_.subject.bus, time_text(now)));
      break;
    case Expect::Kind::Sequence:
      if (matched)
        element(now, fits(expect_.patterns[next_]), fmt::format("{} came on {}", shown, expect_.subject.bus),
                false);
      break;
    default:
      if (matched) occur(now);
  }
}

// The value has become right, or a frame has come.
void Check::occur(Time now) {
  ++count_;
  const std::string name = expect_.subject.is_event()
                               ? expect_.subject.text()
                               : fmt::format("{} = {}", expect_.subject.text(), expect_.condition.text(expect_.subject));
  switch (expect_.kind) {
    case Expect::Kind::Within: return meet();
    case Expect::Kind::Count:
      if (count_ > expect_.most)
        return fail(fmt::format("{} for the {}. time at {}, expected {} at most", name, count_,
                                time_text(now), expect_.most));
      if (expect_.within && count_ >= expect_.least) meet();
      return;
    case Expect::Kind::Every:
      if (last_ && std::abs(now - *last_ - expect_.period) > expect_.tolerance)
        return fail(fmt::format(
            "{} at {} comes {} after the one before, expected every {}{}", name, time_text(now),
            time_text(now - *last_), time_text(expect_.period),
            expect_.tolerance == 0 ? "" : fmt::format(", {} more or less", time_text(expect_.tolerance))));
      last_ = now;
      return;
    default: return;
  }
}

// `first`: what a signal was at the beginning may be the first element or not.
void Check::element(Time now, bool fits, const std::string& shown, bool first) {
  if (!fits) {
    if (!first)
      fail(fmt::format("{} at {}, expected {}, element {} of the sequence", shown, time_text(now), wanted(),
                       next_ + 1));
    return;
  }
  if (++next_ < length()) return;
  next_ = 0;
  ++rounds_;
  if (!expect_.repeat) meet();
}

void Check::finish(Time now) {
  if (verdict_ != Verdict::Open) return;
  const Time until = std::min(now, end_);
  const std::string name = expect_.subject.text();
  const std::string is = last_value_ ? ", is " + expect_.subject.value_text(*last_value_) : "";
  switch (expect_.kind) {
    case Expect::Kind::Within:
      return fail(
          expect_.subject.is_event()
              ? fmt::format("{} did not come from {} to {}", name, time_text(start_), time_text(until))
              : fmt::format("{} did not become {} from {} to {}{}", name, expect_.condition.text(expect_.subject),
                            time_text(start_), time_text(until), is));
    case Expect::Kind::Always:
    case Expect::Kind::Never:
      if (expect_.kind == Expect::Kind::Always && seen_ == 0)
        return fail(fmt::format("nothing came on {} from {} to {}", expect_.subject.bus, time_text(start_),
                                time_text(until)));
      return meet();
    case Expect::Kind::Count:
      if (count_ >= expect_.least) return meet();
      return fail(fmt::format("{}{} {} times from {} to {}, expected {}{}", name,
                              expect_.subject.is_event() ? " came" : " became " + expect_.condition.text(expect_.subject),
                              count_, time_text(start_), time_text(until), expect_.least,
                              expect_.most == expect_.least ? "" : " at least"));
    case Expect::Kind::Every:
      if (count_ < 2)
        return fail(fmt::format("{} {} times from {} to {}, expected every {}", name, count_,
                                time_text(start_), time_text(until), time_text(expect_.period)));
      if (until - *last_ > expect_.period + expect_.tolerance)
        return fail(fmt::format("{} did not come any more after {}, expected every {}", name,
                                time_text(*last_), time_text(expect_.period)));
      return meet();
    case Expect::Kind::Sequence:
      if (expect_.repeat && rounds_ > 0) return meet();
      return fail(fmt::format("{}: element {} of the sequence, {}, did not come from {} to {}{}", name,
                              next_ + 1, wanted(), time_text(start_), time_text(until), is));
    case Expect::Kind::Now:
      return fail(fmt::format("{} at {}: the test ended before", name, time_text(start_)));
  }
}

}  // namespace ipos::tools::testing
