#include "devices/camera/camera.h"

#include <chrono>
#include <condition_variable>
#include <utility>

#include "core/base/srgb.h"

namespace ilf::devices {
namespace {

/// A camera that was pulled out is looked for again this often.
constexpr std::chrono::milliseconds kReopenAfter{500};
/// How long to wait when a source has no frame for now.
constexpr std::chrono::milliseconds kIdle{30};

/// Sleeps, but not longer than until a stop is asked for.
void rest(std::stop_token stop, std::chrono::milliseconds time) {
    std::mutex mutex;
    std::condition_variable_any never;
    std::unique_lock lock(mutex);
    never.wait_for(lock, stop, time, [] { return false; });
}

}  // namespace

Camera::Camera(Open open, std::function<void()> onNews)
    : open_(std::move(open)), onNews_(std::move(onNews)), thread_([this](std::stop_token stop) { run(stop); }) {}

Camera::~Camera() = default;

void Camera::run(std::stop_token stop) {
    while (!stop.stop_requested()) {
        auto source = open_();
        if (source) {
            {
                const std::scoped_lock lock(mutex_);
                state_.open = true;
                state_.name = (*source)->name();
                state_.id = (*source)->id();
                state_.mode = (*source)->mode();
                state_.trouble.clear();
                mayStandStill_ = (*source)->mayStandStill();
                watch_.emplace(steadyNow());
            }
            onNews_();
            (*source)->endWhen(stop);
            const Error end = play(**source, stop);
            if (stop.stop_requested()) return;
            lost(end.what);
        } else {
            lost(source.error().what);
        }
        rest(stop, kReopenAfter);
    }
}

/// Frames until the source fails (the error says why) or a stop is asked for.
Error Camera::play(CameraSource& source, std::stop_token stop) {
    if (state().locked) {  // a camera that came back is locked again
        if (const auto locked = source.lockExposure(true); !locked) return locked.error();
    }
    while (!stop.stop_requested()) {
        if (const auto obeyed = obey(source); !obeyed) {
            const std::scoped_lock lock(mutex_);
            state_.trouble = obeyed.error().what;
        }
        auto frame = source.read();
        if (!frame) return frame.error();
        if (!*frame) {
            rest(stop, kIdle);
            continue;
        }
        {
            const std::scoped_lock lock(mutex_);
            watch_->arrived(**frame);
            state_.position = (*frame)->position;
            state_.mode = source.mode();
        }
        frames_.put(*std::move(*frame));
        onNews_();
    }
    return {};
}

/// What was asked for since the last frame.
Result<void> Camera::obey(CameraSource& source) {
    if (const auto position = seek_.tryTake()) source.seek(*position);
    const auto wanted = lock_.tryTake();
    if (!wanted) return {};
    const auto locked = source.lockExposure(*wanted);
    const std::scoped_lock lock(mutex_);
    if (locked) {
        state_.locked = *wanted;
        state_.trouble.clear();
    }
    return locked;
}

void Camera::lost(const std::string& why) {
    {
        const std::scoped_lock lock(mutex_);
        if (!state_.open && state_.trouble == why) return;
        state_.open = false;
        state_.trouble = why;
    }
    onNews_();
}

/// Also true while the thread waits for a device that gives nothing: ages are of now.
CameraState Camera::state() const {
    const std::scoped_lock lock(mutex_);
    CameraState state = state_;
    if (!watch_) return state;
    const Second now = steadyNow();
    state.frameAge = watch_->age(now);
    state.frozen = !mayStandStill_ && watch_->frozen(now);
    return state;
}

void Camera::lockExposure(bool locked) { lock_.put(locked); }
void Camera::seek(double position) { seek_.put(position); }

Picture asPicture(const Frame& frame) { return toPicture(frame.rgb); }

}  // namespace ilf::devices
