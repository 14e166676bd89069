#include "devices/serial/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace ilf::devices {
namespace {

using std::chrono::steady_clock;

std::string reason(int code) { return std::strerror(code); }  // NOLINT(concurrency-mt-unsafe)

tl::unexpected<Error> cannotOpen(const std::string& path, int code) {
    switch (code) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
        return fail(Fault::notFound, "There is no serial port \"" + path +
                                         "\". Plug the lens driver in, or choose one of the ports that --list-devices "
                                         "names.");
    case EACCES:
    case EPERM:
        return fail(Fault::device, "The serial port \"" + path +
                                       "\" may not be opened by this user. Install the udev rules (doctor offers "
                                       "them), or join the group dialout (sudo usermod -aG dialout $USER) and log in "
                                       "again.");
    case EBUSY:
        return fail(Fault::device, "The serial port \"" + path +
                                       "\" is in use by another program. Close Optotune's own software; if "
                                       "ModemManager probes it, install the udev rules (doctor offers them) and plug "
                                       "the lens driver in again.");
    case ENOTTY:
        return fail(Fault::device, "\"" + path + "\" is not a serial port. Choose one such as /dev/ttyACM0.");
    default:
        return fail(Fault::device, "The serial port \"" + path + "\" does not open: " + reason(code) +
                                       ". Plug the lens driver in again.");
    }
}

class SerialPort final : public SerialLink {
public:
    SerialPort(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;
    ~SerialPort() override { close(descriptor_); }

    const std::string& name() const override { return path_; }

    Result<void> send(std::span<const std::uint8_t> data, Milliseconds limit) override {
        const auto until = steady_clock::now() + limit;
        while (!data.empty()) {
            const ssize_t sent = write(descriptor_, data.data(), data.size());
            if (sent > 0) {
                data = data.subspan(static_cast<std::size_t>(sent));
                continue;
            }
            if (sent < 0 && errno != EAGAIN && errno != EINTR) return lost(errno);
            const auto ready = waited(POLLOUT, until);
            if (!ready) return tl::unexpected(ready.error());
            if (!*ready)
                return fail(Fault::device, "The serial port \"" + path_ + "\" took no more data for " +
                                               std::to_string(limit.count()) + " ms. Plug the lens driver in again.");
        }
        return {};
    }

    Result<Bytes> receive(std::size_t most, Milliseconds limit) override {
        const auto until = steady_clock::now() + limit;
        Bytes data(most);
        for (;;) {
            const ssize_t got = read(descriptor_, data.data(), data.size());
            if (got > 0) {
                data.resize(static_cast<std::size_t>(got));
                return data;
            }
            // The end of the file: the other end has hung up.
            if (got == 0) return lost(EIO);
            if (errno != EAGAIN && errno != EINTR) return lost(errno);
            const auto ready = waited(POLLIN, until);
            if (!ready) return tl::unexpected(ready.error());
            if (!*ready) return Bytes();
        }
    }

private:
    tl::unexpected<Error> lost(int code) const {
        return fail(Fault::device, "The serial port \"" + path_ + "\" is gone (" + reason(code) +
                                       "). Check the USB cable of the lens driver and plug it in again.");
    }

    /// Whether `event` came before `until`.
    Result<bool> waited(short event, steady_clock::time_point until) const {
        for (;;) {
            const auto left = std::chrono::ceil<Milliseconds>(until - steady_clock::now());
            pollfd watched{descriptor_, event, 0};
            const int ready = poll(&watched, 1, static_cast<int>(std::max<Milliseconds::rep>(left.count(), 0)));
            if (ready < 0 && errno == EINTR) continue;
            if (ready < 0) return lost(errno);
            if (ready == 0) return false;
            // What arrived before a hang-up is still read.
            if ((watched.revents & event) != 0) return true;
            return lost(EIO);
        }
    }

    std::string path_;
    int descriptor_;
};

}  // namespace

Result<std::unique_ptr<SerialLink>> openSerialPort(const std::string& path) {
    // O_NONBLOCK: else opening waits for a carrier that CDC-ACM boards do not raise.
    const int descriptor = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return cannotOpen(path, errno);
    auto port = std::make_unique<SerialPort>(path, descriptor);
    termios line{};
    if (tcgetattr(descriptor, &line) != 0) return cannotOpen(path, errno);
    cfmakeraw(&line);
    line.c_cflag |= CLOCAL | CREAD;
    line.c_cflag &= ~static_cast<tcflag_t>(HUPCL | CSTOPB | PARENB | CRTSCTS);
    line.c_cc[VMIN] = 1;  // with 0, "nothing yet" and "hung up" would both read as 0 bytes
    line.c_cc[VTIME] = 0;
    if (cfsetspeed(&line, B115200) != 0 || tcsetattr(descriptor, TCSANOW, &line) != 0) return cannotOpen(path, errno);
    ioctl(descriptor, TIOCEXCL);
    tcflush(descriptor, TCIOFLUSH);
    return port;
}

}  // namespace ilf::devices
