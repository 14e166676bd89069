#include "devices/link/channel.h"

#include <cstring>
#include <vector>
#include <zmq.hpp>

#include "devices/link/codec.h"

namespace ilf::devices {
namespace {

/// One for the process; its I/O thread starts with the first socket.
zmq::context_t& context() {
    static zmq::context_t only(1);
    return only;
}

// A whole program of the largest projector fits; anything larger is not for us.
constexpr std::int64_t kMaxMessageBytes = std::int64_t{1} << 30;

void configure(zmq::socket_t& socket) {
    socket.set(zmq::sockopt::linger, 0);
    socket.set(zmq::sockopt::maxmsgsize, kMaxMessageBytes);
}

zmq::message_t packed(const Message& message) {
    const auto bytes = encoded(message);
    return {bytes.data(), bytes.size()};
}

std::span<const std::byte> bytesOf(const zmq::message_t& frame) { return {frame.data<std::byte>(), frame.size()}; }

bool poll(std::vector<zmq::pollitem_t>& items, std::chrono::milliseconds timeout) {
    try {
        return zmq::poll(items, timeout) > 0;
    } catch (const zmq::error_t&) {
        return false;  // a signal: the caller looks again anyway
    }
}

}  // namespace

struct Server::Socket {
    zmq::socket_t zmq{context(), zmq::socket_type::router};
};

Server::Server(std::unique_ptr<Socket> socket) : socket_(std::move(socket)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::open(const std::string& address) {
    try {
        auto socket = std::make_unique<Socket>();
        configure(socket->zmq);
        socket->zmq.bind(address);
        return std::unique_ptr<Server>(new Server(std::move(socket)));
    } catch (const zmq::error_t& error) {
        return fail(Fault::cannotWrite, "The socket " + address + " cannot be opened (" + error.what() +
                                            "). Is the runtime directory writable?");
    }
}

void Server::wait(std::chrono::milliseconds timeout, std::initializer_list<int> alsoWakes) {
    std::vector<zmq::pollitem_t> items{{socket_->zmq.handle(), 0, ZMQ_POLLIN, 0}};
    for (const int fd : alsoWakes)
        items.push_back({nullptr, fd, ZMQ_POLLIN, 0});
    poll(items, timeout);
}

std::optional<Server::Incoming> Server::receive() {
    try {
        zmq::message_t client;
        if (!socket_->zmq.recv(client, zmq::recv_flags::dontwait)) return std::nullopt;
        zmq::message_t body;
        int frames = 0;
        for (bool more = client.more(); more; more = body.more(), ++frames)
            if (!socket_->zmq.recv(body, zmq::recv_flags::dontwait)) break;
        Incoming incoming{client.to_string(), fail(Fault::badFile, "A message arrived in pieces that are not ours.")};
        if (frames == 1) incoming.message = decoded(bytesOf(body));
        return incoming;
    } catch (const zmq::error_t&) {
        return std::nullopt;
    }
}

void Server::send(const std::string& client, const Message& message) {
    try {
        auto frame = packed(message);
        if (socket_->zmq.send(zmq::buffer(client), zmq::send_flags::sndmore | zmq::send_flags::dontwait))
            socket_->zmq.send(frame, zmq::send_flags::dontwait);
    } catch (const zmq::error_t&) {
        return;  // the client went away between its question and our answer
    }
}

struct Client::Socket {
    explicit Socket(const std::string& address) : zmq(context(), zmq::socket_type::dealer) {
        configure(zmq);
        zmq.set(zmq::sockopt::immediate, true);
        // A core that is restarted is back within tens of milliseconds; knocking is cheap on a local socket.
        zmq.set(zmq::sockopt::reconnect_ivl, 20);
        zmq.connect(address);
    }
    zmq::socket_t zmq;
};

Client::Client(const std::string& address) : socket_(std::make_unique<Socket>(address)) {}
Client::~Client() = default;
Client::Client(Client&&) noexcept = default;
Client& Client::operator=(Client&&) noexcept = default;

bool Client::send(const Message& message, std::chrono::milliseconds timeout) {
    std::vector<zmq::pollitem_t> items{{socket_->zmq.handle(), 0, ZMQ_POLLOUT, 0}};
    if (!poll(items, timeout)) return false;
    try {
        auto frame = packed(message);
        return socket_->zmq.send(frame, zmq::send_flags::dontwait).has_value();
    } catch (const zmq::error_t&) {
        return false;
    }
}

std::optional<Result<Message>> Client::receive(std::chrono::milliseconds timeout) {
    std::vector<zmq::pollitem_t> items{{socket_->zmq.handle(), 0, ZMQ_POLLIN, 0}};
    if (!poll(items, timeout)) return std::nullopt;
    try {
        zmq::message_t frame;
        if (!socket_->zmq.recv(frame, zmq::recv_flags::dontwait)) return std::nullopt;
        return decoded(bytesOf(frame));
    } catch (const zmq::error_t&) {
        return std::nullopt;
    }
}

}  // namespace ilf::devices
