#include "devices/osc/pose_receiver.h"

#include <arpa/inet.h>
#include <lo/lo.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>

#include "devices/camera/frame.h"

namespace ilf::devices {

namespace {

constexpr int kPatience_ms = 100;        // between looks at whether to stop
constexpr std::size_t kMostSaid = 64;    // kinds of mistakes that are told
constexpr std::size_t kMostPoses = 256;  // addresses that are kept

double unixNow() { return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count(); }

void answer(int socket, const sockaddr_in& to, const std::string& address, const std::string& sentence) {
    lo_message message = lo_message_new();
    lo_message_add_string(message, address.c_str());
    lo_message_add_string(message, sentence.c_str());
    std::size_t size = 0;
    if (void* bytes = lo_message_serialise(message, "/if/error", nullptr, &size)) {
        // Nobody need listen to the answer.
        static_cast<void>(
            ::sendto(socket, bytes, size, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to), sizeof to));
        std::free(bytes);
    }
    lo_message_free(message);
}

}  // namespace

Result<std::unique_ptr<PoseReceiver>> PoseReceiver::open(int port, bool others, std::function<void()> onNews) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket < 0)
        return fail(Fault::device, "No socket for poses by OSC: " + std::string(std::strerror(errno)) + ".");
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(static_cast<std::uint16_t>(port));
    at.sin_addr.s_addr = htonl(others ? INADDR_ANY : INADDR_LOOPBACK);
    socklen_t length = sizeof at;
    if (port < 0 || port > 65535 || ::bind(socket, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0 ||
        ::getsockname(socket, reinterpret_cast<sockaddr*>(&at), &length) != 0) {
        const std::string why = port < 0 || port > 65535 ? "there is no such port" : std::strerror(errno);
        ::close(socket);
        return fail(Fault::device, "Poses by OSC cannot be heard on UDP port " + std::to_string(port) + " (" + why +
                                       "): close the program that has it, or choose another port.");
    }
    return std::unique_ptr<PoseReceiver>(new PoseReceiver(socket, ntohs(at.sin_port), std::move(onNews)));
}

PoseReceiver::PoseReceiver(int socket, int port, std::function<void()> onNews)
    : socket_(socket), port_(port), onNews_(std::move(onNews)), thread_([this](std::stop_token s) { run(s); }) {}

PoseReceiver::~PoseReceiver() {
    thread_.request_stop();
    thread_.join();
    ::close(socket_);
}

void PoseReceiver::run(std::stop_token stop) {
    std::array<std::byte, 65536> buffer;
    while (!stop.stop_requested()) {
        pollfd ready{socket_, POLLIN, 0};
        if (::poll(&ready, 1, kPatience_ms) <= 0) continue;
        sockaddr_in from{};
        socklen_t length = sizeof from;
        const auto size = ::recvfrom(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT,
                                     reinterpret_cast<sockaddr*>(&from), &length);
        if (size < 0) continue;
        const Second now = steadyNow();
        const auto says = poseMessage(std::span(buffer.data(), static_cast<std::size_t>(size)), unixNow());
        {
            const std::scoped_lock lock(mutex_);
            if (!says) say(says.error().what);
            for (const OscPose& pose : says ? says->poses : std::vector<OscPose>{}) {
                if (newest_.size() >= kMostPoses && !newest_.contains(pose.address)) continue;
                newest_[pose.address] = {pose, now - Second::fromSi(pose.secondsAgo.value_or(0.0))};
            }
            for (const std::string& address : says ? says->unknown : std::vector<std::string>{}) {
                const std::string sentence = "OSC: nothing listens to " + address + "; poses go to /pose/N.";
                const bool first = !said_.contains(sentence) && said_.size() < kMostSaid;
                say(sentence);
                if (first) answer(socket_, from, address, sentence);
            }
        }
        if (onNews_) onNews_();
    }
}

void PoseReceiver::say(const std::string& sentence) {
    if (said_.size() < kMostSaid && said_.insert(sentence).second) sentences_.push_back(sentence);
}

std::vector<TimedPose> PoseReceiver::take() {
    const std::scoped_lock lock(mutex_);
    std::vector<TimedPose> poses;
    for (auto& [address, pose] : newest_)
        poses.push_back(std::move(pose));
    newest_.clear();
    return poses;
}

std::vector<std::string> PoseReceiver::takeSentences() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(sentences_, {});
}

}  // namespace ilf::devices
