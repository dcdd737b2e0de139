// Cam controllers: bits that tell in which windows a position is. The standard one (IPOSplus p. 86) makes its
// bit each time GETSYS CAM runs, the extended one (p. 91) goes on by itself. Both live in H variables: every
// function gets all of them, and a number that is none of them gives false (F10).
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace ipos::runtime {

// How fast variables that cams watch change, for the dead-time compensation: seen once a millisecond.
class CamSources {
 public:
  // Begins to watch a variable; only a few are watched at a time (ours), others count as at rest.
  void watch(uint32_t variable, std::span<const int32_t> h);
  void tick(std::span<const int32_t> h);
  int32_t change(uint32_t variable) const;  // in the last millisecond
  bool watches_none() const { return !sources_[0].used; }

 private:
  struct Source {
    bool used = false;
    uint32_t variable = 0;
    int32_t value = 0;
    int32_t change = 0;
  };
  std::array<Source, 8> sources_{};
};

// GSCAM at `structure`: sets or clears its bit once.
bool run_standard_cam(uint32_t structure, std::span<int32_t> h, CamSources& sources);

// GSCAM_EXT; the structure is read again every time.
class ExtendedCams {
 public:
  static constexpr size_t kOutputs = 8;

  // GETSYS CAM with bit 31 of the first element set. False also when all are in use.
  bool start(uint32_t structure, std::span<int32_t> h, CamSources& sources);

  struct Status {
    bool referenced;
    uint64_t ms;  // of the run: the first four outputs are computed every millisecond, the others every 4
  };
  // One millisecond. False: a structure leads to no variable; it is stopped.
  bool tick(std::span<int32_t> h, CamSources& sources, const Status& status);
  void stop() { cams_ = {}; }
  bool runs() const {
    for (const Cam& cam : cams_)
      if (cam.used) return true;
    return false;
  }

 private:
  struct Cam {
    bool used = false;
    uint32_t structure = 0;
    uint32_t outputs = 0;  // the internal buffer
  };
  static bool run(Cam& cam, std::span<int32_t> h, CamSources& sources, const Status& status);

  std::array<Cam, 4> cams_{};
};

}  // namespace ipos::runtime
