// The socket, its time stamps and its full queue. Own frames go to all other sockets of this machine
// (loopback on) and not back to us (receipt of own frames off), so nothing has to be recognised.
#include "runtime/os_port/socket_can.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>

namespace ipos::runtime {
namespace {

// The kernel tells nobody when its transmit queue has room again after ENOBUFS: we ask again (ours).
constexpr Time kRetry = kMillisecond;

// Nor does a socket tell that its interface is up again (ours).
constexpr Time kLookAgain = 200 * kMillisecond;

// A stamp further away than this comes from a clock that was set meanwhile (ours).
constexpr Time kLongestReading = 100 * kMicrosecond;
constexpr Time kPlausibleAge = kSecond;

template <typename Value>
bool set_option(int descriptor, int level, int option, const Value& value) {
  return setsockopt(descriptor, level, option, &value, sizeof value) == 0;
}

Frame frame_of(const can_frame& raw) {
  Frame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.length = std::min<uint8_t>(raw.can_dlc, 8);
  std::copy(std::begin(raw.data), std::end(raw.data), frame.data.begin());
  return canonical(frame);
}

can_frame raw_of(const Frame& frame) {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0) | (frame.remote ? CAN_RTR_FLAG : 0);
  raw.can_dlc = frame.length;
  std::copy(frame.data.begin(), frame.data.end(), std::begin(raw.data));
  return raw;
}

Time time_of(const timespec& time) { return static_cast<Time>(time.tv_sec) * kSecond + time.tv_nsec; }

}  // namespace

CanPortResult SocketCan::open(std::string name, uint32_t baud, RealClock& clock) {
  const auto link = query_can_link(name);
  if (!link) return tl::unexpected(link.error());
  if (link->bit_rate && *link->bit_rate != baud)
    return tl::unexpected(port_error(PortFault::WrongBitRate, name,
                                     fmt::format("{} instead of {} bit/s", *link->bit_rate, baud)));
  Descriptor descriptor(socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!descriptor.is_open()) {
    const int error = errno;
    if (error == EAFNOSUPPORT || error == EPROTONOSUPPORT)
      return tl::unexpected(port_error(PortFault::NoCanInKernel, name));
    return tl::unexpected(system_error(error, name));
  }
  const int fd = descriptor.get();
  const can_err_mask_t errors = CAN_ERR_MASK;
  const int stamps = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_RX_HARDWARE |
                     SOF_TIMESTAMPING_RAW_HARDWARE;
  const int receive_buffer = 1 << 20;  // cut by the system to its limit
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = link->index;
  if (!set_option(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors) ||
      !set_option(fd, SOL_SOCKET, SO_TIMESTAMPING, stamps) || !set_option(fd, SOL_SOCKET, SO_RXQ_OVFL, 1) ||
      !set_option(fd, SOL_SOCKET, SO_RCVBUF, receive_buffer) ||
      bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return tl::unexpected(system_error(errno, name));
  std::unique_ptr<SocketCan> port(new SocketCan(std::move(name), std::move(descriptor), clock));
  if (!link->bit_rate && link->kind != "vcan" && link->kind != "vxcan")
    port->notes_.note(fmt::format("the system does not know its bit rate; the bus has {} bit/s", baud));
  return port;
}

PortNeeds SocketCan::needs() const { return {descriptor_.get(), false, queue_.empty() ? kNever : retry_}; }

void SocketCan::send(const Frame& frame) {
  if (queue_.size() >= kCanPortQueue) {
    ++counts_.lost_out;
    notes_.note(
        fmt::format("frames are lost: {} wait to be sent and the system takes none; is there another "
                    "station on the bus, and the same bit rate?",
                    queue_.size()));
    return;
  }
  queue_.push_back(frame);
  if (retry_ == kNever) (void)flush();  // an error is seen by the loop's next flush
}

void SocketCan::go_down() {
  down_ = true;
  look_again_ = clock_.now() + kLookAgain;
}

// The socket stays bound while the interface is down.
tl::expected<void, PortError> SocketCan::look_whether_up() {
  if (!down_ || clock_.now() < look_again_) return {};
  look_again_ = clock_.now() + kLookAgain;
  ifreq request{};
  name_.copy(request.ifr_name, sizeof request.ifr_name - 1);
  if (ioctl(descriptor_.get(), SIOCGIFFLAGS, &request) != 0)
    return tl::unexpected(system_error(errno, name_));
  down_ = (request.ifr_flags & IFF_UP) == 0;
  return {};
}

tl::expected<void, PortError> SocketCan::flush() {
  if (auto looked = look_whether_up(); !looked) return looked;
  if (retry_ != kNever && clock_.now() < retry_) return {};
  retry_ = kNever;
  while (!queue_.empty()) {
    const can_frame raw = raw_of(queue_.front());
    if (write(descriptor_.get(), &raw, sizeof raw) == sizeof raw) {
      queue_.pop_front();
      ++counts_.sent;
      continue;
    }
    switch (errno) {
      case EINTR: continue;
      case ENOBUFS:  // the interface's queue is full; the frame stays first
      case EAGAIN:   // the socket's buffer is full
        ++counts_.waited;
        retry_ = clock_.now() + kRetry;
        return {};
      case ENETDOWN:
        drop_all("the interface is down: frames to it are lost");
        go_down();
        return {};
      case ENODEV:
      case ENXIO: return tl::unexpected(system_error(errno, name_));
      default:
        notes_.note(fmt::format("a frame is refused: {}", std::strerror(errno)));
        ++counts_.lost_out;
        queue_.pop_front();
    }
  }
  return {};
}

void SocketCan::drop_all(const char* why) {
  counts_.lost_out += queue_.size();
  queue_.clear();
  notes_.note(why);
}

// The stamp's age is taken from the clock it was made with. Both clocks must be read without a pause in
// between, or the pause would count as age.
Time SocketCan::host_time(Time stamp) {
  Time now = clock_.now();
  Time wall = clock_.wall();
  for (int tries = 0; tries < 4 && clock_.now() - now > kLongestReading; ++tries) {
    now = clock_.now();
    wall = clock_.wall();
  }
  const Time age = wall - stamp;
  const Time at = stamp == 0 || age < 0 || age > kPlausibleAge ? now : now - age;
  return last_arrival_ = std::max(last_arrival_, at);
}

tl::expected<std::optional<CanArrival>, PortError> SocketCan::receive() {
  can_frame raw{};
  iovec part{&raw, sizeof raw};
  alignas(cmsghdr) char control[256];
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  ssize_t size = recvmsg(descriptor_.get(), &message, 0);
  while (size < 0 && errno == EINTR) size = recvmsg(descriptor_.get(), &message, 0);
  if (size < 0) {
    if (errno == EAGAIN) return std::nullopt;
    if (errno != ENETDOWN) return tl::unexpected(system_error(errno, name_));
    notes_.note("the interface has been set down");
    go_down();
    return std::nullopt;
  }
  Time software = 0;
  CanArrival arrival{};
  for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr; head = CMSG_NXTHDR(&message, head)) {
    if (head->cmsg_level != SOL_SOCKET) continue;
    if (head->cmsg_type == SO_TIMESTAMPING) {
      scm_timestamping stamps{};
      std::memcpy(&stamps, CMSG_DATA(head), sizeof stamps);
      software = time_of(stamps.ts[0]);
      if (const Time hardware = time_of(stamps.ts[2]); hardware != 0) arrival.device_time = hardware;
    } else if (head->cmsg_type == SO_RXQ_OVFL) {
      uint32_t overruns = 0;
      std::memcpy(&overruns, CMSG_DATA(head), sizeof overruns);
      if (overruns != overruns_) notes_.note("frames from it are lost: they came faster than they were read");
      counts_.lost_in += overruns - overruns_;
      overruns_ = overruns;
    }
  }
  arrival.at = host_time(software);
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    arrival.error.emplace();
    arrival.error->classes = raw.can_id & CAN_ERR_MASK;
    std::copy(std::begin(raw.data), std::end(raw.data), arrival.error->data.begin());
  } else {
    ++counts_.received;
    arrival.frame = frame_of(raw);
  }
  return arrival;
}

}  // namespace ipos::runtime
