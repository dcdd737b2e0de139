// Two machines in an event loop: a timer lets each catch up with the clock, frames of one are events for the
// other. Everything happens in one thread; nothing blocks.
#include <asio.hpp>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <ipos.hpp>
#include <iterator>
#include <vector>

namespace {

using namespace std::chrono_literals;

constexpr auto kRunTime = 500ms;
constexpr uint32_t kMostTicks = 100;  // one timer event never runs longer than this

class Station {
 public:
  Station(asio::io_context& loop, const char* image_file) : loop_(loop), timer_(loop) {
    std::ifstream in(image_file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    image_.resize(bytes.size() / 8 + 1);
    std::memcpy(image_.data(), bytes.data(), bytes.size());
    status_ = program_.load(std::as_bytes(std::span(image_)).first(bytes.size()));
    if (status_ == IPOS_OK) status_ = machine_.init(program_, *this);
    if (status_ == IPOS_OK) status_ = machine_.start();
  }
  ipos_status status() const { return status_; }

  void connect(Station& partner) { partner_ = &partner; }
  void run() {
    if (machine_.run_due(kMostTicks) != IPOS_OK) return;
    timer_.expires_after(1ms);
    timer_.async_wait([this](const asio::error_code& error) {
      if (!error) run();
    });
  }

  // Callbacks of the machine. A frame arrives after the command that sends it is over, as an event of its
  // own.
  ipos_sending send(ipos_vm*, const ipos_frame& frame, uint32_t) {
    asio::post(loop_, [partner = partner_, frame] {
      if (partner->machine_.receive(frame) == IPOS_OK) ++partner->received_;
    });
    return IPOS_SENDING_DONE;
  }
  uint64_t time_us() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
  }

  unsigned received() const { return received_; }
  int32_t value(const char* name) const {
    int32_t value = 0;
    machine_.read(name, value);
    return value;
  }

 private:
  asio::io_context& loop_;
  asio::steady_timer timer_;
  std::vector<uint64_t> image_;
  ipos::Program program_;
  ipos::Machine machine_;
  ipos_status status_;
  Station* partner_ = nullptr;
  unsigned received_ = 0;
};

}  // namespace

// event_loop SCOM1.ipx SCOM2.ipx
int main(int argc, char** argv) {
  if (argc != 3) return std::puts("event_loop SCOM1.ipx SCOM2.ipx"), 64;
  asio::io_context loop;
  Station one(loop, argv[1]), two(loop, argv[2]);
  for (const Station* station : {&one, &two})
    if (station->status() != IPOS_OK) return std::puts(ipos_status_text(station->status())), 1;
  one.connect(two);
  two.connect(one);
  one.run();
  two.run();
  loop.run_for(kRunTime);
  std::printf("one received: %s %08x, two received: %s %08x\n", one.received() > 2 ? "yes" : "no",
              static_cast<unsigned>(one.value("lReDataLow")), two.received() > 2 ? "yes" : "no",
              static_cast<unsigned>(two.value("lReDataLow")));
  return one.received() > 2 && two.received() > 2 ? 0 : 1;
}
