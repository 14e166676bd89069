#include "core/base/parallel.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace ilf {

namespace {

/// One helper that sleeps between loops: starting a thread for each loop would cost more than most loops do.
class Helper {
public:
    Helper() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

    void loop(int count, const std::function<void(int)>& work) {
        next_ = 0;
        {
            const std::scoped_lock lock(mutex_);
            count_ = count;
            work_ = &work;
            helping_ = true;
        }
        changed_.notify_all();
        takeAll(count, work);
        std::unique_lock lock(mutex_);
        // A helper that has not woken yet finds nothing to do.
        work_ = nullptr;
        changed_.wait(lock, [this] { return !busy_; });
        helping_ = false;
        if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    }

    std::atomic<bool> inUse{false};  // not a mutex: the same thread may ask again from inside `work`

private:
    void takeAll(int count, const std::function<void(int)>& work) {
        try {
            for (int i = next_++; i < count; i = next_++)
                work(i);
        } catch (...) {  // memory ran out: the loop ends, and its caller is told once nobody works any more
            next_ = count;
            const std::scoped_lock lock(mutex_);
            if (!thrown_) thrown_ = std::current_exception();
        }
    }
    void run(const std::stop_token& stop) {
        std::unique_lock lock(mutex_);
        while (changed_.wait(lock, stop, [this] { return work_ != nullptr && helping_; })) {
            const std::function<void(int)>& work = *work_;
            const int count = count_;
            busy_ = true;
            helping_ = false;  // once a loop
            lock.unlock();
            takeAll(count, work);
            lock.lock();
            busy_ = false;
            changed_.notify_all();
        }
    }

    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::atomic<int> next_{0};
    int count_ = 0;
    const std::function<void(int)>* work_ = nullptr;
    std::exception_ptr thrown_;
    bool helping_ = false;
    bool busy_ = false;
    std::jthread thread_;  // last: it joins before what it uses goes
};

/// Lets the helper go, however the loop ends.
struct Released {
    std::atomic<bool>& inUse;
    ~Released() { inUse = false; }
};

}  // namespace

void parallelFor(int count, const std::function<void(int)>& work) {
    // Waking the helper costs some 10 us: a lone index is not worth it.
    if (count > 1) {
        static Helper helper;
        if (!helper.inUse.exchange(true)) {
            const Released released{helper.inUse};
            helper.loop(count, work);
            return;
        }
    }
    for (int i = 0; i < count; ++i)
        work(i);
}

}  // namespace ilf
