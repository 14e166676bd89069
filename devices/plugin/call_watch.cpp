#include "devices/plugin/call_watch.h"

#include <utility>

namespace ilf::devices {

CallWatch::CallWatch(HangingCall hanging) : hanging_(std::move(hanging)) {
    if (hanging_.noticed) thread_ = std::jthread([this](const std::stop_token& stop) { watch(stop); });
}

void CallWatch::began(std::string sentence, Second longest) {
    if (!hanging_.noticed) return;
    const auto patience = std::chrono::duration<double>((longest + hanging_.patience).si());
    {
        const std::lock_guard lock(mutex_);
        sentence_ = std::move(sentence);
        deadline_ = std::chrono::steady_clock::now() +
                    std::chrono::duration_cast<std::chrono::steady_clock::duration>(patience);
    }
    changed_.notify_one();
}

void CallWatch::ended() {
    if (!hanging_.noticed) return;
    const std::lock_guard lock(mutex_);
    deadline_.reset();  // the thread sees it when it wakes: waking it for each call would only cost
}

void CallWatch::watch(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (changed_.wait(lock, stop, [&] { return deadline_.has_value(); })) {
        const auto deadline = *deadline_;
        changed_.wait_until(lock, stop, deadline, [&] { return deadline_ != deadline; });
        if (stop.stop_requested()) return;
        if (deadline_ != deadline || std::chrono::steady_clock::now() < deadline) continue;
        deadline_.reset();
        const std::string sentence = sentence_;
        lock.unlock();
        hanging_.noticed(sentence);
        lock.lock();
    }
}

}  // namespace ilf::devices
