// Boost.Beast on one thread; the only file that includes it, as its headers take half a minute to read.
#include "tools/serve/server.hpp"

#include <algorithm>
#include <deque>
#include <list>
#include <map>
#include <optional>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include <fmt/format.h>

#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/serve/arrival.hpp"
#include "tools/serve/channel.hpp"
#include "tools/serve/random_bytes.hpp"

namespace ipos::tools::serve {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Error = beast::error_code;
using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;
#ifdef BOOST_ASIO_HAS_LOCAL_SOCKETS
using HostSocket = asio::local::stream_protocol::socket;
const asio::local::stream_protocol kHostProtocol;
#else
using HostSocket = tcp::socket;
const tcp kHostProtocol = tcp::v4();
#endif
// Windows lets two programs listen at one port with the option that lets POSIX listen at one that was left a moment ago,
// and it needs another one to let nobody else listen.
#ifdef SO_EXCLUSIVEADDRUSE
using ListenOption = asio::detail::socket_option::boolean<SOL_SOCKET, SO_EXCLUSIVEADDRUSE>;
#else
using ListenOption = asio::socket_base::reuse_address;
#endif

constexpr auto kRequestTime = std::chrono::seconds(10);
constexpr auto kFarewell = std::chrono::seconds(2);

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

// Takes the same time wherever the two differ.
bool same(std::string_view given, std::string_view wanted) {
  unsigned difference = given.size() == wanted.size() ? 0 : 1;
  for (size_t n = 0; n < wanted.size(); ++n)
    difference |=
        static_cast<unsigned char>(wanted[n]) ^ static_cast<unsigned char>(n < given.size() ? given[n] : 0);
  return difference == 0;
}

std::string_view token_of(std::string_view target) {
  const size_t question = target.find('?');
  std::string_view rest =
      question == std::string_view::npos ? std::string_view{} : target.substr(question + 1);
  while (!rest.empty()) {
    const size_t end = rest.find('&');
    const std::string_view part = rest.substr(0, end);
    if (part.starts_with("token=")) return part.substr(6);
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  }
  return {};
}

}  // namespace

std::string make_token() {
  std::array<unsigned char, 16> bytes{};
  if (!random_bytes(bytes))
    throw Failure(kIoError, "the system gives no random numbers for the token");
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

class Server::Listener {
 public:
  Listener(ServerOptions options, serve::Socket host) : options_(std::move(options)), acceptor_(io_), host_(io_) {
    host_.assign(kHostProtocol, static_cast<HostSocket::native_handle_type>(host));
    Error error;
    const auto address = asio::ip::make_address(options_.bind, error);
    if (error)
      throw Failure(kUsage,
                    fmt::format("--bind {}: this is no address, write for example 127.0.0.1", options_.bind));
    if (!options_.rather || listen({address, *options_.rather})) error = listen({address, options_.port});
    if (error)
      throw Failure(kIoError, fmt::format("port {} of {} cannot be listened at: {}", options_.port,
                                          options_.bind, error.message()));
    port_ = acceptor_.local_endpoint().port();
    any_address_ = address.is_unspecified();
  }

  std::string address() const {
    const std::string host = any_address_ ? "127.0.0.1" : options_.bind;
    return fmt::format("http://{}:{}/?token={}",
                       host.find(':') == std::string::npos ? host : "[" + host + "]", port_, options_.token);
  }

  uint16_t port() const { return port_; }

  void run(const std::function<void()>& ready) {
    ready_ = ready;
    read_head();
    stay_awake();
    io_.run();
  }

 private:
  class Connection;
  class Socket;

  Error listen(const tcp::endpoint& at) {
    Error error, ignored;
    acceptor_.close(ignored);
    acceptor_.open(at.protocol(), error);
    if (!error) acceptor_.set_option(ListenOption(true), error);
    if (!error) acceptor_.bind(at, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    return error;
  }

  // --- the host ---
  void read_head() {
    asio::async_read(host_, asio::buffer(head_), [this](Error error, size_t) {
      if (error) return host_gone();
      const MessageHead head = head_of(head_);
      message_ = {head.kind, head.client, std::string(head.length, '\0'), {}};
      asio::async_read(host_, asio::buffer(message_.body), [this](Error broken, size_t) {
        if (broken) return host_gone();
        take(message_);
        read_head();
      });
    });
  }
  void take(Message& message);
  void host_gone() {
    host_there_ = false;
    end();
  }
  void tell_host(MessageKind kind, uint16_t client, std::string body = {},
                 WallClock::time_point arrived = {}) {
    if (!host_there_) return;
    Message message{kind, client, std::move(body), arrived};
    const auto head = head_bytes(message);
    to_host_.push_back(std::string(head.data(), head.size()) + message.body);
    if (to_host_.size() == 1) write_to_host();
  }
  void write_to_host() {
    asio::async_write(host_, asio::buffer(to_host_.front()), [this](Error error, size_t) {
      to_host_.pop_front();
      if (error) to_host_.clear();
      if (!to_host_.empty()) write_to_host();
    });
  }

  // --- browsers ---
  void accept() {
    acceptor_.async_accept([this](Error error, tcp::socket socket) {
      if (error == asio::error::operation_aborted || ending_) return;
      if (!error) {
        begin(std::move(socket));
        return accept();
      }
      // No descriptor left, perhaps: a moment later there may be one.
      pause_.expires_after(std::chrono::milliseconds(100));
      pause_.async_wait([this](Error) { accept(); });
    });
  }
  void begin(tcp::socket socket);
  std::optional<uint16_t> free_number();
  // Reads the clock each time, so that a pause of this process is known before the first message after it is read.
  WallClock::time_point now() {
    const auto now = WallClock::now();
    arrival_.awake(now);
    return now;
  }
  void stay_awake() {
    (void)now();
    if (interrupted()) return end();
    heartbeat_.expires_after(Arrival::kNap / 5);
    heartbeat_.async_wait([this](Error error) {
      if (!error) stay_awake();
    });
  }
  bool is_ours(std::string_view host) const;
  std::optional<std::pair<http::status, std::string>> refusal(const Request& request) const;
  Response answer(const Request& request) const;
  Response make(http::status status, unsigned version, std::string body, const char* type) const;

  void end();

  ServerOptions options_;
  // Connections of one request; the longest silent one is in front. Those that are left at the end go with `io_` and leave
  // this list, so it lives longer.
  std::list<Connection*> asking_;
  asio::io_context io_{1};
  tcp::acceptor acceptor_;
  HostSocket host_;
  asio::steady_timer pause_{io_};
  asio::steady_timer farewell_{io_};
  uint16_t port_ = 0;
  bool any_address_ = false;
  bool host_there_ = true;
  bool ending_ = false;
  std::function<void()> ready_;
  std::array<char, kMessageHead> head_{};
  Message message_;
  std::deque<std::string> to_host_;
  Arrival arrival_;
  asio::steady_timer heartbeat_{io_};
  uint16_t last_client_ = 0;
  std::map<uint16_t, std::shared_ptr<Socket>> sockets_;
};

// One WebSocket. It reads on only when the host keeps up, and holds no more than so much for a browser that does not.
class Server::Listener::Socket : public std::enable_shared_from_this<Socket> {
 public:
  Socket(Listener& listener, beast::tcp_stream stream, uint16_t number)
      : listener_(listener), stream_(std::move(stream)), number_(number) {}

  void accept(const Request& request) {
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    stream_.read_message_max(kMostMessage);
    stream_.auto_fragment(false);
    stream_.async_accept(request, [self = shared_from_this()](Error error) {
      if (error) return self->gone();
      self->open_ = true;
      self->listener_.tell_host(MessageKind::Opened, self->number_);
      self->read();
    });
  }

  void send(MessageKind kind, std::string body) {
    if (!open_ || closing_) return;
    waiting_ += body.size();
    out_.push_back({kind, std::move(body)});
    if (waiting_ > kMostWaiting) return close(websocket::close_code::policy_error);
    if (!writing_) write();
  }
  void taken() {
    --unanswered_;
    if (!held_ || unanswered_ >= kMostUnanswered) return;
    arrival_.resume(WallClock::now());
    read();
  }
  void close(websocket::close_code code) {
    if (!open_ || closing_) return;
    closing_ = true;
    if (writing_) {  // it does not read: there is no polite way
      beast::get_lowest_layer(stream_).cancel();
      return;
    }
    stream_.async_close(code, [self = shared_from_this()](Error) { self->gone(); });
  }

 private:
  void read() {
    held_ = false;
    stream_.async_read(buffer_, [self = shared_from_this()](Error error, size_t) {
      if (error) return self->gone();
      const auto now = self->listener_.now();
      self->listener_.tell_host(
          MessageKind::Text, self->number_, beast::buffers_to_string(self->buffer_.data()),
          std::min(self->arrival_.of_message(now), self->listener_.arrival_.of_message(now)));
      self->buffer_.consume(self->buffer_.size());
      self->held_ = ++self->unanswered_ >= kMostUnanswered;
      if (!self->held_) return self->read();
      self->arrival_.pause(now);
    });
  }
  void write() {
    writing_ = true;
    stream_.binary(out_.front().kind == MessageKind::Binary);
    stream_.async_write(asio::buffer(out_.front().body), [self = shared_from_this()](Error error, size_t) {
      self->writing_ = false;
      if (error) return self->gone();
      const auto& sent = self->out_.front();
      self->waiting_ -= sent.body.size();
      if (sent.kind != MessageKind::Reply)
        self->listener_.tell_host(MessageKind::Drained, self->number_, std::to_string(sent.body.size()));
      self->out_.pop_front();
      if (!self->out_.empty() && !self->closing_) self->write();
    });
  }
  void gone() {
    if (std::exchange(gone_, true)) return;
    if (open_) listener_.tell_host(MessageKind::Closed, number_);
    open_ = false;
    out_.clear();
    beast::get_lowest_layer(stream_).close();
    const auto self = shared_from_this();  // the listener has the last other one
    listener_.sockets_.erase(number_);
    if (listener_.ending_ && listener_.sockets_.empty()) listener_.io_.stop();
  }

  struct Out {
    MessageKind kind;
    std::string body;
  };
  Listener& listener_;
  websocket::stream<beast::tcp_stream> stream_;
  uint16_t number_;
  beast::flat_buffer buffer_;
  std::deque<Out> out_;
  size_t waiting_ = 0;
  int unanswered_ = 0;
  Arrival arrival_;
  bool open_ = false, closing_ = false, gone_ = false, writing_ = false, held_ = false;
};

// One request of HTTP, and its answer.
class Server::Listener::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Listener& listener, tcp::socket socket) : listener_(listener), stream_(std::move(socket)) {
    place_ = listener_.asking_.insert(listener_.asking_.end(), this);
    parser_.header_limit(kMostHeader);
    parser_.body_limit(kMostBody);
  }
  ~Connection() {
    if (!ended_) listener_.asking_.erase(place_);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void read() {
    stream_.expires_after(kRequestTime);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](Error error, size_t) { self->on_read(error); });
  }
  // Makes room for somebody who asks for something.
  void end() {
    ended_ = true;
    listener_.asking_.erase(place_);
    Error ignored;
    stream_.socket().close(ignored);
  }

 private:
  void on_read(Error error) {
    if (ended_) return;
    listener_.asking_.splice(listener_.asking_.end(), listener_.asking_, place_);
    if (error == http::error::header_limit)
      return write(http::status::request_header_fields_too_large, "the header is too long\n");
    if (error == http::error::body_limit)
      return write(http::status::payload_too_large, "the body is too long\n");
    if (error && error.category() == http::make_error_code(http::error::bad_method).category() &&
        error != http::error::end_of_stream && error != http::error::partial_message)
      return write(http::status::bad_request, "this is no HTTP\n");
    if (error) return;
    const Request& request = parser_.get();
    const bool is_socket = websocket::is_upgrade(request) && view(request.target()).starts_with("/ws");
    if (!is_socket) return write(listener_.answer(request));
    if (const auto refused = listener_.refusal(request)) return write(refused->first, refused->second);
    const auto number = listener_.free_number();
    if (!number)
      return write(http::status::service_unavailable,
                   fmt::format("there are {} clients already\n", kMostClients));
    const auto socket = std::make_shared<Socket>(listener_, std::move(stream_), *number);
    listener_.sockets_[*number] = socket;
    socket->accept(request);
  }
  void write(http::status status, const std::string& text) {
    write(listener_.make(status, 11, text, "text/plain; charset=utf-8"));
  }
  void write(Response response) {
    response_ = std::move(response);
    http::async_write(stream_, response_, [self = shared_from_this()](Error, size_t) {
      Error ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Listener& listener_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  Response response_;
  std::list<Connection*>::iterator place_;
  bool ended_ = false;
};

// The longest silent client is dropped: silent ones keep nobody out.
void Server::Listener::begin(tcp::socket socket) {
  if (asking_.size() + sockets_.size() >= kMostConnections && !asking_.empty()) asking_.front()->end();
  std::make_shared<Connection>(*this, std::move(socket))->read();
}

// An old client may still have a number when numbers start again.
std::optional<uint16_t> Server::Listener::free_number() {
  if (sockets_.size() >= kMostClients) return std::nullopt;
  do
    last_client_ =
        last_client_ < options_.last_number ? static_cast<uint16_t>(last_client_ + 1) : uint16_t{1};
  while (sockets_.contains(last_client_));
  return last_client_;
}

void Server::Listener::take(Message& message) {
  if (message.kind == MessageKind::Ready) {
    ready_();
    return accept();
  }
  const auto found = sockets_.find(message.client);
  if (found == sockets_.end()) return;
  const std::shared_ptr<Socket> socket = found->second;
  if (message.kind == MessageKind::Taken) return socket->taken();
  socket->send(message.kind, std::move(message.body));
}

// A foreign name that leads to this machine is not ours (DNS rebinding); any address of it is, as it was listened at all.
bool Server::Listener::is_ours(std::string_view host) const {
  const std::string port = fmt::format(":{}", port_);
  if (!host.ends_with(port))
    return port_ == 80 && host.find(':') == std::string_view::npos && is_ours(std::string(host) + port);
  host.remove_suffix(port.size());
  if (host == "127.0.0.1" || host == "localhost" || host == "[::1]" || host == options_.bind) return true;
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  if (host == options_.bind) return true;
  Error error;
  asio::ip::make_address(std::string(host), error);
  return any_address_ && !error;
}

std::optional<std::pair<http::status, std::string>> Server::Listener::refusal(const Request& request) const {
  const std::string_view host = view(request[http::field::host]);
  if (request.count(http::field::host) != 1 || !is_ours(host))
    return {{http::status::forbidden, "this is not the host you asked for\n"}};
  if (request.count(http::field::origin) != 0 &&
      view(request[http::field::origin]) != fmt::format("http://{}", host))
    return {{http::status::forbidden, "another page may not ask\n"}};
  const std::string_view target = view(request.target());
  const std::string_view path = target.substr(0, target.find('?'));
  if (path != "/" && path != "/ws") return {{http::status::not_found, "there is only the page\n"}};
  if (request.method() != http::verb::get) return {{http::status::method_not_allowed, "only GET\n"}};
  if (!same(token_of(target), options_.token))
    return {{http::status::unauthorized,
             "<!doctype html><meta charset=\"utf-8\"><title>ipos</title><h1>The token is missing or wrong</h1>"
             "<p>This is an address of another time: open the one that <code>ipos serve</code> has printed last, with "
             "its token.</p>\n"}};
  return std::nullopt;
}

Response Server::Listener::answer(const Request& request) const {
  if (const auto refused = refusal(request))
    return make(refused->first, request.version(), refused->second,
                refused->first == http::status::unauthorized ? "text/html; charset=utf-8"
                                                             : "text/plain; charset=utf-8");
  if (view(request.target()).starts_with("/ws")) {
    Response response = make(http::status::upgrade_required, request.version(), "this is a WebSocket\n",
                             "text/plain; charset=utf-8");
    response.set(http::field::upgrade, "websocket");
    return response;
  }
  return make(http::status::ok, request.version(), std::string(options_.page), "text/html; charset=utf-8");
}

Response Server::Listener::make(http::status status, unsigned version, std::string body,
                                const char* type) const {
  Response response(status, version);
  response.set(http::field::content_type, type);
  response.set(
      "Content-Security-Policy",
      "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
      "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set(http::field::cache_control, "no-store");
  response.keep_alive(false);
  if (status == http::status::method_not_allowed) response.set(http::field::allow, "GET");
  response.body() = std::move(body);
  response.prepare_payload();
  return response;
}

// The browsers hear that it ends, the host that nobody listens any more; what is not gone after that goes anyway.
void Server::Listener::end() {
  if (std::exchange(ending_, true)) return;
  Error ignored;
  acceptor_.close(ignored);
  pause_.cancel();
  heartbeat_.cancel();
  host_.close(ignored);
  host_there_ = false;
  const auto sockets = sockets_;
  for (const auto& [number, socket] : sockets) socket->close(websocket::close_code::going_away);
  farewell_.expires_after(sockets.empty() ? std::chrono::seconds(0) : kFarewell);
  farewell_.async_wait([this](Error) { io_.stop(); });
  if (sockets.empty()) io_.stop();
}

Server::Server(const ServerOptions& options, serve::Socket host) try
    : listener_(std::make_unique<Listener>(options, host)) {
} catch (const boost::system::system_error& error) {  // descriptors of its own, mostly
  throw Failure(kIoError, fmt::format("the system does not give what a server needs: {}", error.what()));
}
Server::~Server() = default;
std::string Server::address() const { return listener_->address(); }
uint16_t Server::port() const { return listener_->port(); }
void Server::run(const std::function<void()>& ready) { listener_->run(ready); }

}  // namespace ipos::tools::serve
