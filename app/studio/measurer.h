// Measures a rig for the window: the wizard's states on the main thread, its devices on a thread of their own.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/measure/measure_place.h"
#include "devices/link/runtime_directory.h"
#include "devices/measure/wizard.h"
#include "ui/measure_view.h"

namespace ilf::app {

/// How a place is opened; tests open one where things go wrong.
using OpenMeasurePlace = std::function<Result<std::unique_ptr<MeasurePlace>>(
    const MeasureOrder&, std::function<bool()> stop, devices::MeasureWatch watch)>;

/// Lenses move only while a step is worked on, and rest again whatever comes of it. While real devices are held, the
/// player's lock and the mark of a stage in use are held as well: should this process die, the white guard lets the
/// lenses rest.
class Measurer {
public:
    /// `onNews` is called on the measuring thread when `collect` has something.
    Measurer(std::filesystem::path runtimeDirectory, std::function<void()> onNews,
             OpenMeasurePlace open = &MeasurePlace::open);
    /// Ends a step that is worked on, with the lenses at rest.
    ~Measurer();
    Measurer(const Measurer&) = delete;
    Measurer& operator=(const Measurer&) = delete;

    /// None: the page is closed.
    const std::optional<ui::MeasureView>& view() const { return view_; }
    /// Begun and not over: nothing else may use the rig.
    bool busy() const;
    /// The output core must be stopped, or stay so.
    bool wantsDevices() const { return view_ && view_->holdsDevices; }

    /// Opens the page for this rig; refused when it cannot be measured.
    Result<void> offer(const std::string& word, const Rig& rig);
    /// What was refused stands in the view.
    void begin(const ui::MeasureSetup& setup);
    /// The output core has let go of the devices, or would not.
    void devicesAreFree(const Result<void>& freed);

    // Each does nothing where the wizard's state does not allow it.
    void go();
    void next();
    void again();
    void back();
    /// Ends the step that is worked on, as one that was not good.
    void stopStep() { stop_ = true; }
    void cancel();
    void store(const std::string& path);
    /// The rig with what was measured and stored.
    std::optional<Rig> measuredRig(const Rig& rig) const;

    /// Takes what the measuring thread has done; true if there was anything.
    bool collect();

private:
    using Task = std::function<void()>;
    void run(const std::stop_token& stop);
    void later(Task task);
    void answer(Task onMainThread);
    void openPlace();
    void work();
    void opened(Result<std::vector<devices::MeasureStep>> steps);
    void judged(devices::StepOutcome outcome);
    void closed();
    void show();
    devices::MeasureWatch watch();
    void said(const std::string& what);
    void heard(const devices::HeardBlock& block, double samplesPerSecond);
    void recorded(const LensRecord& wave);
    void published(bool now);

    std::filesystem::path directory_;
    std::function<void()> onNews_;
    OpenMeasurePlace open_;

    // The main thread's.
    std::optional<ui::MeasureView> view_;
    std::optional<devices::MeasureWizard> wizard_;
    MeasureOrder order_;
    std::optional<devices::MeasuredRig> stored_;
    bool simulated_ = true;
    bool awaitsDevices_ = false;

    std::atomic<bool> stop_{false};
    std::mutex mutex_;  ///< guards what follows
    std::condition_variable_any arrived_;
    std::deque<Task> tasks_, answers_;
    /// What the view shows of a step that is worked on.
    struct Live {
        std::string doing, waveName;
        std::vector<ui::ChartPoint> input0, photodiode, powers, known, wave, drive;
    };
    std::optional<Live> news_;

    // The measuring thread's.
    std::unique_ptr<MeasurePlace> place_;
    std::optional<devices::FileLock> stage_;
    Live live_;
    std::vector<double> heard0_, heard1_;
    std::chrono::steady_clock::time_point publishedAt_;

    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
