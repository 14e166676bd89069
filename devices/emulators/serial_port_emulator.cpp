#include "devices/emulators/serial_port_emulator.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/eventfd.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <mutex>
#include <stop_token>
#include <system_error>
#include <thread>

namespace ilf::devices::emulators {

struct SerialPortEmulator::Impl {
    EmulatedLensDriver& device;
    std::filesystem::path link;
    Clock clock;
    std::mutex lock;  ///< the device and the terminal
    int master = -1, slave = -1;
    int wake = -1;        ///< an eventfd: the terminal has changed, or it is time to stop
    std::jthread thread;  ///< last, so that it ends first

    Impl(EmulatedLensDriver& served, std::filesystem::path at, Clock now)
        : device(served), link(std::move(at)), clock(std::move(now)), wake(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        thread.request_stop();
        interrupt();
        if (thread.joinable()) thread.join();
        pull();
        if (wake >= 0) close(wake);
    }

    void interrupt() const {
        const std::uint64_t one = 1;
        [[maybe_unused]] const ssize_t written = write(wake, &one, sizeof one);
    }
    /// With `lock` held, or after the thread.
    void pull() {
        if (master < 0) return;
        std::error_code ignored;
        std::filesystem::remove(link, ignored);
        close(slave);
        close(master);
        master = slave = -1;
        device.powerCycle(clock());
    }
    Result<void> plug();
    void serve(const std::stop_token& stop);
};

Result<void> SerialPortEmulator::Impl::plug() {
    if (master >= 0) return {};
    const auto refused = [&](const std::string& what, int error) {
        return fail(Fault::device, "An emulated serial port at " + link.string() + " is not possible: " + what + ": " +
                                       std::strerror(error) + ".");
    };
    std::array<char, 128> name{};
    if (openpty(&master, &slave, name.data(), nullptr, nullptr) != 0) {
        master = slave = -1;
        return refused("no pseudo-terminal", errno);
    }
    // Raw, so that nothing is echoed before a program has set the port up. The slave stays open here: without it the
    // terminal hangs up between two programs that open the port.
    termios raw{};
    tcgetattr(slave, &raw);
    cfmakeraw(&raw);
    tcsetattr(slave, TCSANOW, &raw);
    fcntl(master, F_SETFL, O_NONBLOCK);
    fcntl(master, F_SETFD, FD_CLOEXEC);
    fcntl(slave, F_SETFD, FD_CLOEXEC);
    std::error_code error;
    std::filesystem::remove(link, error);
    std::filesystem::create_symlink(name.data(), link, error);
    if (error) {
        pull();
        return refused("no link", error.value());
    }
    return {};
}

void SerialPortEmulator::Impl::serve(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        pollfd watched[2] = {{wake, POLLIN, 0}, {-1, POLLIN, 0}};
        {
            const std::scoped_lock held(lock);
            watched[1].fd = master;
        }
        if (poll(watched, 2, -1) < 0 && errno != EINTR) return;
        std::uint64_t count = 0;
        [[maybe_unused]] const ssize_t drained = read(wake, &count, sizeof count);
        if ((watched[1].revents & (POLLIN | POLLHUP | POLLERR)) == 0) continue;

        const std::scoped_lock held(lock);
        if (master < 0 || master != watched[1].fd) continue;
        std::array<std::uint8_t, 512> bytes{};
        const ssize_t received = read(master, bytes.data(), bytes.size());
        if (received <= 0) continue;
        const SerialAnswer answer = device.receive(std::span(bytes).first(std::size_t(received)), clock());
        // A program that does not read loses what does not fit, as behind a real USB line.
        [[maybe_unused]] const ssize_t sent = write(master, answer.reply.data(), answer.reply.size());
        if (answer.gone) pull();
    }
}

Result<std::unique_ptr<SerialPortEmulator>> SerialPortEmulator::started(EmulatedLensDriver& device,
                                                                        std::filesystem::path link, Clock clock) {
    if (!clock)
        clock = [] {
            return std::chrono::duration_cast<std::chrono::nanoseconds>(
                       std::chrono::steady_clock::now().time_since_epoch())
                .count();
        };
    auto impl = std::make_unique<Impl>(device, std::move(link), std::move(clock));
    if (auto plugged = impl->plug(); !plugged) return tl::unexpected(plugged.error());
    Impl& served = *impl;
    impl->thread = std::jthread([&served](const std::stop_token& stop) { served.serve(stop); });
    return std::unique_ptr<SerialPortEmulator>(new SerialPortEmulator(std::move(impl)));
}

SerialPortEmulator::SerialPortEmulator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SerialPortEmulator::~SerialPortEmulator() = default;

const std::filesystem::path& SerialPortEmulator::link() const { return impl_->link; }

void SerialPortEmulator::unplug() {
    {
        const std::scoped_lock held(impl_->lock);
        impl_->pull();
    }
    impl_->interrupt();
}

Result<void> SerialPortEmulator::plug() {
    Result<void> plugged;
    {
        const std::scoped_lock held(impl_->lock);
        plugged = impl_->plug();
    }
    impl_->interrupt();
    return plugged;
}

bool SerialPortEmulator::plugged() const {
    const std::scoped_lock held(impl_->lock);
    return impl_->master >= 0;
}

void SerialPortEmulator::locked(const std::function<void(std::int64_t now_ns)>& work) {
    const std::scoped_lock held(impl_->lock);
    work(impl_->clock());
}

}  // namespace ilf::devices::emulators
