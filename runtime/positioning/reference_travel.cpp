// All types but 0 and 5 are one search with other switches and directions.
#include "runtime/positioning/reference_travel.hpp"

namespace ipos::runtime {
namespace {

struct Search {
  int to;      // direction of the search
  int leave;   // direction in which the end of the switch is looked for
  bool limit;  // the switch is the limit switch of the search direction, else the cam
  bool turns;  // a limit switch turns the search round
};

constexpr Search kSearches[] = {
    {},                      // 0: zero pulse only
    {-1, -1, false, true},   // 1
    {+1, +1, false, true},   // 2
    {+1, -1, true, false},   // 3
    {-1, +1, true, false},   // 4
    {},                      // 5: no travel
    {+1, -1, false, false},  // 6
    {-1, +1, false, false},  // 7
};
constexpr int kZeroPulseOnly = 0;
constexpr int kNoTravel = 5;
constexpr int kTypes = 8;

bool limit_of(const ReferenceInputs& in, int way) { return way > 0 ? in.limit_cw : in.limit_ccw; }

}  // namespace

void ReferenceTravel::start(int type, bool zero_pulse) {
  active_ = true;
  type_ = type >= 0 && type < kTypes ? type : kZeroPulseOnly;
  zero_pulse_ = zero_pulse;
  step_ = type_ == kZeroPulseOnly ? Step::ZeroPulse : Step::Search;
  turned_ = seen_ = false;
  order_ = {};
}

ReferenceTravel::Outcome ReferenceTravel::tick(const ReferenceInputs& in) {
  if (type_ == kNoTravel) return reach(in.position);
  if (type_ != kZeroPulseOnly) {
    if (kSearches[type_].limit && !in.has_limits) return Outcome::LimitsMissing;
    if (!kSearches[type_].limit && !in.has_cam) return Outcome::CamMissing;
  }
  switch (step_) {
    case Step::Search: return search(in);
    case Step::Leave: return leave(in);
    case Step::ZeroPulse: break;
  }
  return find_zero_pulse(in);
}

bool ReferenceTravel::moves() const { return type_ != kNoTravel; }

bool ReferenceTravel::on_switch(const ReferenceInputs& in) const {
  const Search& s = kSearches[type_];
  return s.limit ? limit_of(in, s.to) : in.cam;
}

ReferenceTravel::Outcome ReferenceTravel::search(const ReferenceInputs& in) {
  const Search& s = kSearches[type_];
  if (on_switch(in)) {
    step_ = Step::Leave;
    return leave(in);
  }
  const int way = turned_ ? -s.to : s.to;
  if (limit_of(in, way)) {
    // The cam lies on the other side, or nowhere.
    if (!s.turns || turned_) return Outcome::CamMissing;
    turned_ = true;
  }
  order_ = {turned_ ? -s.to : s.to, true};
  return Outcome::Moving;
}

ReferenceTravel::Outcome ReferenceTravel::leave(const ReferenceInputs& in) {
  const int way = kSearches[type_].leave;
  order_ = {way, false};
  if (in.way == -way) return Outcome::Moving;  // still braking from the search
  const bool on = on_switch(in);
  if (seen_ && !on) {
    if (!zero_pulse_) return reach(in.position);
    step_ = Step::ZeroPulse;
    return Outcome::Moving;
  }
  seen_ = seen_ || on;
  return limit_of(in, way) ? Outcome::CamMissing : Outcome::Moving;
}

ReferenceTravel::Outcome ReferenceTravel::find_zero_pulse(const ReferenceInputs& in) {
  const int way = type_ == kZeroPulseOnly ? -1 : kSearches[type_].leave;
  order_ = {way, false};
  if (const auto& pulse = way > 0 ? in.zero_pulse_cw : in.zero_pulse_ccw) return reach(*pulse);
  return limit_of(in, way) ? Outcome::CamMissing : Outcome::Moving;
}

ReferenceTravel::Outcome ReferenceTravel::reach(int32_t position) {
  found_ = position;
  active_ = false;
  return Outcome::Found;
}

}  // namespace ipos::runtime
