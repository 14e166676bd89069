#include "devices/emulated_rig/emulated_rig.h"

#include <poll.h>
#include <unistd.h>

#include <cstdlib>
#include <deque>
#include <map>

#include "devices/emulated_rig/rig_video.h"
#include "devices/link/channel.h"
#include "devices/link/rig_environment.h"
#include "devices/link/runtime_directory.h"

namespace ilf::devices {
namespace {

constexpr std::size_t kLogLines = 50;
constexpr std::size_t kClients = 8;  // whose last sweep is kept

bool readable(int fd) {
    pollfd item{fd, POLLIN, 0};
    return poll(&item, 1, 0) > 0;
}

/// What this process was preloaded with: it worked here.
std::string preload() {
    const char* value = std::getenv("LD_PRELOAD");  // NOLINT(concurrency-mt-unsafe): nothing here sets variables
    return value != nullptr && *value != '\0' ? value : emulators::kUsbPreload;
}

/// Its environment file, while there is one.
struct Announced {
    std::filesystem::path directory;
    ~Announced() { removeRigEnvironment(directory); }
};

class RigServer {
public:
    RigServer(RigCables& cables, RigVideo& video, const std::function<void(const std::string&)>& said)
        : cables_(cables), video_(video), said_(said) {}

    Body answered(const std::string& client, const Body& request) {
        if (std::holds_alternative<Read>(request)) {
            DeviceState state = cables_.state();
            state.pid = getpid();
            state.log = {log_.begin(), log_.end()};
            return state;
        }
        if (std::holds_alternative<ReadReceived>(request)) {
            if (held_.size() >= kClients && !held_.contains(client)) held_.clear();
            Received received = cables_.received(held_[client]);
            received.log = {log_.begin(), log_.end()};
            return received;
        }
        if (const auto* asked = std::get_if<ReadExposure>(&request)) return exposure(client, asked->number);
        if (const auto* mishap = std::get_if<RigMishap>(&request)) {
            const auto done = mishap->device == "display" ? video_.befall(*mishap) : cables_.befall(*mishap);
            if (!done) return Refused{done.error(), false};
            note(mishap->device + ": " + mishap->kind);
            return Done{monotonicNs()};
        }
        return Refused{{Fault::unsupported,
                        "The devices of an emulated rig take orders by their cables alone, from the player that drives "
                        "them."},
                       false};
    }
    void note(const std::string& line) {
        said_(line);
        log_.push_back(line);
        while (log_.size() > kLogLines)
            log_.pop_front();
    }

private:
    Body exposure(const std::string& client, int number) const {
        const auto held = held_.find(client);
        if (held == held_.end() || number < 0 || std::size_t(number) >= held->second.size())
            return Refused{{Fault::outOfRange, "There is no exposure " + std::to_string(number) +
                                                   " in the sweep that was asked for last."},
                           false};
        return ExposedLight{number,
                            {emulators::kMirrorColumns, emulators::kMirrorRows},
                            held->second[static_cast<std::size_t>(number)].light()};
    }

    RigCables& cables_;
    RigVideo& video_;
    const std::function<void(const std::string&)>& said_;
    std::deque<std::string> log_;
    std::map<std::string, std::vector<emulators::LightSlot>> held_;
};

}  // namespace

Result<void> serveEmulatedRig(const std::filesystem::path& runtimeDirectory, LensPreset lens, int stopDescriptor,
                              const std::function<void(const std::string&)>& said) {
    auto lock = FileLock::tryTake(devicesLock(runtimeDirectory));
    if (!lock) return tl::unexpected(lock.error());
    if (!*lock) return fail(Fault::device, "Devices run in this runtime directory already.");
    removeRigEnvironment(runtimeDirectory);  // of one that was killed
    auto server = Server::open(devicesAddress(runtimeDirectory));
    if (!server) return tl::unexpected(server.error());
    auto cables = RigCables::started(lens);
    if (!cables) return tl::unexpected(cables.error());
    auto video = RigVideo::started(**cables);
    if (!video) return tl::unexpected(video.error());

    RigServer rig(**cables, **video, said);
    rig.note("emulated rig: projector at USB " + std::string(kEmulatedProjectorAt) + " and display " +
             (*video)->displayName() + ", lenses (" + std::string(word(lens)) + ") at USB " + kEmulatedLensesAt);
    const Announced announced{runtimeDirectory};
    auto ready = saveRigEnvironment(
        runtimeDirectory,
        {{"UMOCKDEV_DIR", (*cables)->busDirectory()}, {"DISPLAY", (*video)->displayName()}, {"LD_PRELOAD", preload()}});
    if (!ready) return ready;
    while (!readable(stopDescriptor)) {
        (*server)->wait(std::chrono::milliseconds(200), {stopDescriptor});
        if (const auto trouble = (*video)->trouble()) rig.note(*trouble);
        while (auto incoming = (*server)->receive()) {
            const auto& [client, message] = *incoming;
            if (!message) {
                rig.note(message.error().what);
                (*server)->send(client, {0, Refused{message.error(), false}});
                continue;
            }
            (*server)->send(client, {message->id, rig.answered(client, message->body)});
        }
    }
    said("switched off");
    return {};
}

}  // namespace ilf::devices
