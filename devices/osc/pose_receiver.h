// Poses that other programs send by OSC over UDP.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "devices/osc/pose_message.h"

namespace ilf::devices {

struct TimedPose {
    OscPose pose;
    Second time;  ///< steadyNow() when it arrived, less what the bundle's time tag says
};

/// Listens on a thread of its own. Only to this machine until it is asked to listen to others (operators.md 4.4).
class PoseReceiver {
public:
    static constexpr int kPort = 9720;  // operators.md 4.4: free of the usual neighbours' ports

    /// Port 0 takes any that is free. Refused: a port that another program has.
    static Result<std::unique_ptr<PoseReceiver>> open(int port = kPort, bool others = false,
                                                      std::function<void()> onNews = {});
    ~PoseReceiver();

    int port() const { return port_; }
    /// The newest pose of each address since the last call.
    std::vector<TimedPose> take();
    /// What was wrong since the last call, each kind once: bad messages, unknown addresses (which were answered with
    /// /if/error address sentence, once each).
    std::vector<std::string> takeSentences();

private:
    PoseReceiver(int socket, int port, std::function<void()> onNews);
    void run(std::stop_token stop);
    void say(const std::string& sentence);

    int socket_;
    int port_;
    std::function<void()> onNews_;
    std::mutex mutex_;
    std::map<std::string, TimedPose> newest_;
    std::vector<std::string> sentences_;
    std::set<std::string> said_;  ///< bounded: anyone may send
    std::jthread thread_;         // last: joins before what it uses goes
};

}  // namespace ilf::devices
