// Messages over a local socket (ZeroMQ over ipc): one server, any number of clients, each used by one thread.
#pragma once

#include <chrono>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>

#include "devices/link/messages.h"

namespace ilf::devices {

/// The end that waits to be called. Opening takes the address over from a server that died.
class Server {
public:
    struct Incoming {
        std::string client;       ///< who: stays the same while the client is connected
        Result<Message> message;  ///< or why what arrived is no message
    };

    static Result<std::unique_ptr<Server>> open(const std::string& address);
    ~Server();

    /// Waits until a message is there, one of the plain descriptors `alsoWakes` can be read, or `timeout` has passed.
    void wait(std::chrono::milliseconds timeout, std::initializer_list<int> alsoWakes = {});
    /// The next message, without waiting.
    std::optional<Incoming> receive();
    /// Never waits: a client that is gone, or too slow to read, misses it.
    void send(const std::string& client, const Message& message);

private:
    struct Socket;
    explicit Server(std::unique_ptr<Socket> socket);
    std::unique_ptr<Socket> socket_;
};

/// The end that calls. Connects, and connects again, by itself; what is sent while nobody listens is refused rather
/// than kept for later.
class Client {
public:
    explicit Client(const std::string& address);
    ~Client();
    Client(Client&&) noexcept;
    Client& operator=(Client&&) noexcept;

    /// False if nobody is connected at the other end within `timeout`.
    bool send(const Message& message, std::chrono::milliseconds timeout = std::chrono::milliseconds(0));
    /// The next message within `timeout`; nothing if none came. Bytes that are no message come as an error.
    std::optional<Result<Message>> receive(std::chrono::milliseconds timeout);

private:
    struct Socket;
    std::unique_ptr<Socket> socket_;
};

}  // namespace ilf::devices
