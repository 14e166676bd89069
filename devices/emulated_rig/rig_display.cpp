#include "devices/emulated_rig/rig_display.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ipc.h>
#include <sys/prctl.h>
#include <sys/shm.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xcb/damage.h>
#include <xcb/shm.h>
#include <xcb/xcb.h>

#include <array>
#include <atomic>
#include <cassert>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <thread>
#include <vector>

extern char** environ;

namespace ilf::devices {
namespace {

using namespace std::chrono_literals;

constexpr auto kLongestStart = 20s;  // a machine that does much else
constexpr auto kLongestEnd = 3s;

struct Freed {
    void operator()(void* memory) const { std::free(memory); }
};
template <class T>
using Reply = std::unique_ptr<T, Freed>;

std::string programInPath(const char* name) {
    const char* path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::filesystem::path file = std::filesystem::path(folder) / name;
        if (access(file.c_str(), X_OK) == 0) return file.string();
    }
    return {};
}

/// A process that ends when this object does, or when the thread that made it does.
class ServerProcess {
public:
    ServerProcess() = default;
    explicit ServerProcess(pid_t pid) : pid_(pid) {}
    ServerProcess(ServerProcess&& other) noexcept : pid_(std::exchange(other.pid_, 0)) {}
    ServerProcess& operator=(ServerProcess&& other) noexcept {
        std::swap(pid_, other.pid_);
        return *this;
    }
    ~ServerProcess() {
        if (pid_ <= 0) return;
        kill(pid_, SIGTERM);
        const auto deadline = std::chrono::steady_clock::now() + kLongestEnd;
        while (waitpid(pid_, nullptr, WNOHANG) == 0) {
            if (std::chrono::steady_clock::now() > deadline) {
                kill(pid_, SIGKILL);
                waitpid(pid_, nullptr, 0);
                break;
            }
            std::this_thread::sleep_for(5ms);
        }
    }

private:
    pid_t pid_ = 0;
};

/// `environ` without what shows programs the emulated bus.
std::vector<char*> plainEnvironment() {
    std::vector<char*> variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view one = *variable;
        if (!one.starts_with("LD_PRELOAD=") && !one.starts_with("UMOCKDEV_DIR=")) variables.push_back(*variable);
    }
    variables.push_back(nullptr);
    return variables;
}

pid_t startedProgram(const std::string& program, std::vector<std::string> arguments) {
    std::vector<char*> words;
    words.reserve(arguments.size() + 1);
    for (std::string& argument : arguments)
        words.push_back(argument.data());
    words.push_back(nullptr);
    const std::vector<char*> variables = plainEnvironment();
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    const pid_t parent = getpid();
    const pid_t pid = fork();
    if (pid != 0) {
        close(nowhere);
        return pid;
    }
    // Between fork and exec only what is safe in a signal handler, and nothing that umockdev wraps: it takes locks.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    if (getppid() != parent) _exit(1);
    for (const int stream : {0, 1, 2})
        dup2(nowhere, stream);
    execve(program.c_str(), words.data(), variables.data());
    _exit(127);
}

/// A line the server writes once it can be connected to: its display's number.
Result<int> numberFrom(int descriptor) {
    std::string line;
    const auto deadline = std::chrono::steady_clock::now() + kLongestStart;
    while (line.find('\n') == std::string::npos) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
        pollfd item{descriptor, POLLIN, 0};
        std::array<char, 16> part{};
        if (left.count() <= 0 || poll(&item, 1, static_cast<int>(left.count())) <= 0)
            return fail(Fault::device, "The emulated projector's display (Xvfb) did not start in time; the machine may "
                                       "be overloaded.");
        const ssize_t bytes = read(descriptor, part.data(), part.size());
        if (bytes <= 0)
            return fail(Fault::device, "The emulated projector's display (Xvfb) ended before it was ready; try "
                                       "\"Xvfb :99\" to see why.");
        line.append(part.data(), static_cast<std::size_t>(bytes));
    }
    return std::atoi(line.c_str());
}

tl::unexpected<Error> lost() {
    return fail(Fault::device, "The emulated projector's display is gone: its X server does not answer.");
}

}  // namespace

struct RigDisplay::Impl {
    ServerProcess server;  ///< first, so that it ends after the connection
    int number = 0;
    Size size;
    xcb_connection_t* x = nullptr;
    xcb_window_t root = 0;
    xcb_shm_seg_t segment = 0;
    std::uint8_t* pixels = nullptr;
    std::uint8_t damageEvent = 0;
    xcb_damage_damage_t damage = 0;
    emulators::FramePtr frame;

    ~Impl() {
        if (x != nullptr) xcb_disconnect(x);
        if (pixels != nullptr) shmdt(pixels);
    }
    Result<void> connected();
    Result<void> sharesMemory();
    Result<void> taken();
};

RigDisplay::RigDisplay(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RigDisplay::~RigDisplay() = default;
int RigDisplay::number() const { return impl_->number; }

Result<std::unique_ptr<RigDisplay>> RigDisplay::started(Size size, int number) {
    const std::string program = programInPath("Xvfb");
    if (program.empty())
        return fail(Fault::notFound, "The emulated projector's display needs Xvfb, which is not installed (Debian "
                                     "package xvfb).");
    std::array<int, 2> pipe{};
    if (pipe2(pipe.data(), O_CLOEXEC) != 0) return fail(Fault::device, "There are no more files for a display's pipe.");
    // Far above those that servers take by themselves: while it is unplugged, nobody else takes its number.
    static std::atomic<int> made = 0;
    if (number < 0) number = 2000 + (8 * getpid() + made++) % 40'000;
    std::vector<std::string> arguments{program, ":" + std::to_string(number)};
    const std::string screen = std::to_string(size.width) + "x" + std::to_string(size.height) + "x24";
    const int toUs = dup(pipe[1]);  // not closed by exec
    for (const std::string& word :
         {std::string("-displayfd"), std::to_string(toUs), std::string("-screen"), std::string("0"), screen,
          std::string("-nolisten"), std::string("tcp"), std::string("-noreset"), std::string("-wr")})
        arguments.push_back(word);
    auto impl = std::make_unique<Impl>();
    impl->server = ServerProcess(startedProgram(program, std::move(arguments)));
    close(pipe[1]);
    close(toUs);
    const auto ready = numberFrom(pipe[0]);
    close(pipe[0]);
    if (!ready) return tl::unexpected(ready.error());
    impl->number = *ready;
    impl->size = size;
    if (auto connected = impl->connected(); !connected) return tl::unexpected(connected.error());
    return std::unique_ptr<RigDisplay>(new RigDisplay(std::move(impl)));
}

Result<void> RigDisplay::Impl::connected() {
    x = xcb_connect((":" + std::to_string(number)).c_str(), nullptr);
    if (xcb_connection_has_error(x) != 0) return lost();
    const xcb_screen_t* screen = xcb_setup_roots_iterator(xcb_get_setup(x)).data;
    root = screen->root;
    const xcb_query_extension_reply_t* extension = xcb_get_extension_data(x, &xcb_damage_id);
    if (extension == nullptr || extension->present == 0)
        return fail(Fault::unsupported, "The emulated projector's display has no damage extension.");
    damageEvent = static_cast<std::uint8_t>(extension->first_event + XCB_DAMAGE_NOTIFY);
    const Reply<xcb_damage_query_version_reply_t> version(
        xcb_damage_query_version_reply(x, xcb_damage_query_version(x, 1, 1), nullptr));
    damage = xcb_generate_id(x);
    xcb_damage_create(x, damage, root, XCB_DAMAGE_REPORT_LEVEL_NON_EMPTY);
    if (auto shares = sharesMemory(); !shares) return shares;
    return taken();
}

Result<void> RigDisplay::Impl::sharesMemory() {
    const std::size_t bytes = 4 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    const int id = shmget(IPC_PRIVATE, bytes, IPC_CREAT | 0600);
    void* memory = id >= 0 ? shmat(id, nullptr, 0) : nullptr;
    if (memory == nullptr || reinterpret_cast<std::intptr_t>(memory) == -1)
        return fail(Fault::device, "There is no shared memory for the emulated projector's picture.");
    pixels = static_cast<std::uint8_t*>(memory);
    segment = xcb_generate_id(x);
    const Reply<xcb_generic_error_t> refused(
        xcb_request_check(x, xcb_shm_attach_checked(x, segment, static_cast<std::uint32_t>(id), 0)));
    shmctl(id, IPC_RMID, nullptr);  // it goes with its users
    if (refused) return fail(Fault::device, "The emulated projector's display does not share its memory.");
    return {};
}

/// The root window with all that lies on it, as one request: never half a picture.
Result<void> RigDisplay::Impl::taken() {
    const auto request =
        xcb_shm_get_image(x, root, 0, 0, static_cast<std::uint16_t>(size.width),
                          static_cast<std::uint16_t>(size.height), ~0U, XCB_IMAGE_FORMAT_Z_PIXMAP, segment, 0);
    const Reply<xcb_shm_get_image_reply_t> reply(xcb_shm_get_image_reply(x, request, nullptr));
    if (!reply) return lost();
    auto picture = std::make_shared<emulators::VideoFrame>();
    picture->width = size.width;
    picture->height = size.height;
    const std::size_t count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    picture->rgb.resize(3 * count);
    // 24 bits of colour in 32, blue first on the machines we build for.
    std::uint8_t* to = picture->rgb.data();
    for (const std::uint8_t* from = pixels; from != pixels + 4 * count; from += 4, to += 3) {
        to[0] = from[2];
        to[1] = from[1];
        to[2] = from[0];
    }
    if (!frame || frame->rgb != picture->rgb) frame = std::move(picture);
    return {};
}

Result<emulators::FramePtr> RigDisplay::picture() {
    bool changed = false;
    while (const Reply<xcb_generic_event_t> event{xcb_poll_for_event(impl_->x)})
        changed = changed || (event->response_type & 0x7FU) == impl_->damageEvent;
    if (xcb_connection_has_error(impl_->x) != 0) return tl::unexpected(lost().value());
    if (changed) {
        // Told again of what is drawn from here on, and so nothing is missed.
        xcb_damage_subtract(impl_->x, impl_->damage, XCB_NONE, XCB_NONE);
        if (auto there = impl_->taken(); !there) return tl::unexpected(there.error());
    }
    return impl_->frame;
}

}  // namespace ilf::devices
