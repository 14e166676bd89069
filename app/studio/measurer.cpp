#include "app/studio/measurer.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <sstream>
#include <utility>

#include "app/measure/measured_files.h"
#include "app/output_core/stage_mark.h"
#include "app/words.h"

namespace ilf::app {
namespace {

using devices::MeasureStep;
using devices::StepOutcome;
using MeasureState = ui::MeasureView::State;

/// Three sweeps at 60 Hz.
constexpr double kHeard_s = 0.05;
constexpr std::chrono::milliseconds kBetweenNews{33};
constexpr std::size_t kDrawn = 240;

/// At most about `kDrawn` points of what was heard last.
std::vector<ui::ChartPoint> traceOf(const std::vector<double>& volts, double samplesPerSecond) {
    std::vector<ui::ChartPoint> points;
    const std::size_t step = std::max<std::size_t>(1, volts.size() / (2 * kDrawn));
    for (std::size_t i = 0; i < volts.size(); i += step)
        points.push_back({1e3 * static_cast<double>(i) / samplesPerSecond, volts[i]});
    return points;
}

/// One period, closed.
std::vector<ui::ChartPoint> periodOf(const std::vector<double>& values, Hertz rate, double unit) {
    std::vector<ui::ChartPoint> points;
    for (std::size_t i = 0; i <= values.size(); ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(values.size());
        points.push_back({1e3 * share / rate.si(), unit * values[i % values.size()]});
    }
    return points;
}

std::vector<ui::ChartPoint> pointsOf(const std::vector<StaticPower>& powers) {
    std::vector<ui::ChartPoint> points;
    for (const StaticPower& one : powers)
        points.push_back({1e3 * one.current.si(), one.power.si()});
    return points;
}

/// What only the operator of real devices can say.
Result<void> saidOf(const ui::MeasureSetup& setup, MeasureOrder& order) {
    std::istringstream lines(setup.known);
    auto known = knownPowers(lines, "Known powers");
    if (!known) return tl::unexpected(std::move(known.error()));
    if (known->size() < 2)
        return fail(Fault::outOfRange, "Say at least two powers of the lens that are known, \"milliamperes, dioptres\" "
                                       "a line: a photodiode alone knows no dioptres.");
    order.known = *std::move(known);
    order.temperature_C = wholeNumber(setup.temperature);
    if (!order.temperature_C || *order.temperature_C < 0.0 || *order.temperature_C > 80.0)
        return fail(Fault::outOfRange, "Say how warm the lens is, 0 to 80 degrees C: its powers drift by 0.03 D for "
                                       "each degree.");
    return {};
}

}  // namespace

Measurer::Measurer(std::filesystem::path runtimeDirectory, std::function<void()> onNews, OpenMeasurePlace open)
    : directory_(std::move(runtimeDirectory)), onNews_(std::move(onNews)), open_(std::move(open)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Measurer::~Measurer() {
    stop_ = true;
    thread_.request_stop();
}

void Measurer::run(const std::stop_token& stop) {
    while (true) {
        Task task;
        {
            std::unique_lock lock(mutex_);
            if (!arrived_.wait(lock, stop, [this] { return !tasks_.empty(); })) break;
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        task();
    }
    closed();
}

void Measurer::later(Task task) {
    {
        const std::scoped_lock lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    arrived_.notify_one();
}

void Measurer::answer(Task onMainThread) {
    {
        const std::scoped_lock lock(mutex_);
        answers_.push_back(std::move(onMainThread));
    }
    if (onNews_) onNews_();
}

bool Measurer::collect() {
    std::deque<Task> answers;
    std::optional<Live> news;
    {
        const std::scoped_lock lock(mutex_);
        answers.swap(answers_);
        news = std::exchange(news_, std::nullopt);
    }
    if (news && view_) {
        view_->doing = std::move(news->doing);
        view_->waveName = std::move(news->waveName);
        view_->input0 = std::move(news->input0);
        view_->photodiode = std::move(news->photodiode);
        view_->powers = std::move(news->powers);
        view_->known = std::move(news->known);
        view_->wave = std::move(news->wave);
        view_->drive = std::move(news->drive);
    }
    for (const Task& one : answers)
        one();
    return news || !answers.empty();
}

bool Measurer::busy() const {
    return view_ && view_->state != MeasureState::setup && view_->state != MeasureState::stored;
}

Result<void> Measurer::offer(const std::string& word, const Rig& rig) {
    if (view_) return {};
    if (auto may = measurable(word, rig); !may) return may;
    order_ = {};
    order_.word = word;
    order_.rig = rig;
    order_.rate = rig.sweepRate;
    view_.emplace();
    view_->rig = rig.name;
    view_->emulated = onEmulatedBench(word);
    return {};
}

void Measurer::begin(const ui::MeasureSetup& setup) {
    if (!view_ || view_->state != MeasureState::setup) return;
    view_->trouble.clear();
    order_.eye = view_->eye = setup.eye;
    order_.projector = setup.projector;
    order_.model = setup.model;
    order_.serial = setup.serial;
    if (!view_->emulated) {
        if (auto said = saidOf(setup, order_); !said) {
            view_->trouble = said.error().what;
            return;
        }
        view_->holdsDevices = awaitsDevices_ = true;
    }
    view_->state = MeasureState::preparing;
    if (view_->emulated) openPlace();
}

void Measurer::devicesAreFree(const Result<void>& freed) {
    if (!std::exchange(awaitsDevices_, false) || !wantsDevices() || view_->state != MeasureState::preparing) return;
    if (freed) return openPlace();
    opened(tl::unexpected(freed.error()));
}

void Measurer::openPlace() {
    stop_ = false;
    later([this, order = order_, holds = view_->holdsDevices] {
        Result<std::vector<MeasureStep>> steps;
        bool simulated = true;
        const auto made = [&]() -> Result<void> {
            if (holds) {
                auto lock = devices::FileLock::tryTake(devices::playerLock(directory_));
                if (!lock) return tl::unexpected(std::move(lock.error()));
                if (!*lock)
                    return fail(Fault::device, "Another process of the output core still holds the rig; stop it with "
                                               "illuminatedfocus-core --stop, then begin again.");
                stage_ = *std::move(lock);
                markStage(directory_, Dioptre());
            }
            auto place = open_(order, [this] { return stop_.load(); }, watch());
            if (!place) return tl::unexpected(std::move(place.error()));
            place_ = *std::move(place);
            live_ = {};
            live_.known = pointsOf(place_->known());
            steps = place_->steps();
            simulated = place_->simulated();
            return {};
        }();
        if (!made) {
            closed();
            steps = tl::unexpected(made.error());
        }
        answer([this, steps = std::move(steps), simulated] {
            simulated_ = simulated;
            opened(steps);
        });
    });
}

void Measurer::opened(Result<std::vector<MeasureStep>> steps) {
    if (!view_ || view_->state != MeasureState::preparing) return;
    if (!steps) {
        view_->trouble = steps.error().what;
        view_->state = MeasureState::setup;
        view_->holdsDevices = false;
        return;
    }
    wizard_.emplace(*std::move(steps));
    show();
}

/// The wizard's state, in the view.
void Measurer::show() {
    using Wizard = devices::MeasureWizard::State;
    const Wizard state = wizard_->state();
    const auto& outcomes = wizard_->outcomes();
    view_->state = state == Wizard::connecting  ? MeasureState::connecting
                   : state == Wizard::measuring ? MeasureState::working
                   : state == Wizard::judged    ? MeasureState::judged
                                                : MeasureState::good;
    view_->at = std::min(wizard_->number(), wizard_->steps().size() - 1);
    view_->steps.clear();
    for (std::size_t i = 0; i < wizard_->steps().size(); ++i) {
        const auto words = devices::wordsOf(wizard_->steps()[i], order_.eye);
        ui::MeasureStepView step{words.title, words.connect, words.expect, ui::MeasureStanding::waiting, "", ""};
        const bool here = i == wizard_->number();
        if (i < outcomes.size() && !(here && state == Wizard::measuring)) {
            step.standing = outcomes[i].good ? ui::MeasureStanding::good : ui::MeasureStanding::bad;
            step.measured = outcomes[i].measured;
            step.advice = outcomes[i].advice;
        } else if (here) {
            step.standing = state == Wizard::measuring ? ui::MeasureStanding::working : ui::MeasureStanding::now;
        }
        view_->steps.push_back(std::move(step));
    }
}

void Measurer::work() {
    const MeasureStep step = *wizard_->step();
    stop_ = false;
    view_->doing.clear();
    show();
    later([this, step] {
        StepOutcome outcome;
        try {
            place_->connected(step);
            live_.doing.clear();
            if (step == MeasureStep::powers) live_.powers.clear();
            if (step == MeasureStep::waves) live_.wave.clear(), live_.drive.clear();
            outcome = place_->measurement().perform(step, [this](const std::string& what) { said(what); });
            const auto& found = place_->measurement().measured();
            if (step == MeasureStep::powers && found.sweep) live_.powers = pointsOf(found.sweep->powers);
        } catch (const std::exception& e) {
            outcome = {false, "", std::string("The step ended early: ") + e.what() + ". Measure it again."};
        }
        published(true);
        answer([this, outcome = std::move(outcome)] { judged(outcome); });
    });
}

void Measurer::judged(StepOutcome outcome) {
    if (!view_ || !wizard_ || !wizard_->measured(std::move(outcome))) return;
    show();
}

void Measurer::go() {
    if (wizard_ && wizard_->connected()) work();
}

void Measurer::next() {
    if (!wizard_ || !wizard_->next()) return;
    // Where nothing has to be connected, nothing is asked.
    if (const auto step = wizard_->step(); step && !devices::needsHands(*step)) return go();
    show();
}

void Measurer::again() {
    if (!wizard_ || !wizard_->retry()) return;
    if (!devices::needsHands(*wizard_->step())) return go();
    show();
}

void Measurer::back() {
    if (view_ && view_->state == MeasureState::good) {
        // The wizard is done; the last step's outcome is all that is given up.
        const auto outcomes = wizard_->outcomes();
        const auto steps = wizard_->steps();
        wizard_.emplace(steps);
        for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
            wizard_->connected();
            wizard_->measured(outcomes[i]);
            wizard_->next();
        }
        return show();
    }
    if (wizard_ && wizard_->back()) show();
}

void Measurer::cancel() {
    if (!view_ || view_->state == MeasureState::ending || view_->state == MeasureState::storing) return;
    if (wizard_) wizard_->cancel();
    const bool opening = view_->state != MeasureState::setup;
    stop_ = true;
    awaitsDevices_ = false;
    if (!opening) return view_.reset();
    view_->state = MeasureState::ending;
    later([this] {
        closed();
        answer([this] {
            view_.reset();
            wizard_.reset();
            stored_.reset();
        });
    });
}

void Measurer::closed() {
    place_.reset();
    if (!stage_) return;
    unmarkStage(directory_);
    stage_.reset();
}

void Measurer::store(const std::string& path) {
    if (!view_ || view_->state != MeasureState::good) return;
    view_->state = MeasureState::storing;
    view_->trouble.clear();
    later([this, path] {
        const devices::MeasuredRig measured = place_->measurement().measured();
        auto saved = projects::saveWaves(path, measuredWaves(measured, place_->order(), place_->simulated()));
        answer([this, path, measured, saved = std::move(saved)] {
            if (!view_ || view_->state != MeasureState::storing) return;
            if (!saved) {
                view_->state = MeasureState::good;
                view_->trouble = saved.error().what;
                return;
            }
            view_->state = MeasureState::stored;
            view_->file = path;
            stored_ = measured;
            // Nothing more is asked of the devices.
            later([this] {
                closed();
                answer([this] {
                    if (view_) view_->holdsDevices = false;
                });
            });
        });
    });
}

std::optional<Rig> Measurer::measuredRig(const Rig& rig) const {
    if (!view_ || !stored_) return std::nullopt;
    return withMeasured(rig, *stored_, order_.eye, view_->file, simulated_);
}

devices::MeasureWatch Measurer::watch() {
    return {[this](const devices::HeardBlock& block, double rate) { heard(block, rate); },
            [this](const LensRecord& wave) { recorded(wave); }};
}

void Measurer::said(const std::string& what) {
    live_.doing = what;
    published(false);
}

void Measurer::heard(const devices::HeardBlock& block, double samplesPerSecond) {
    const auto kept = static_cast<std::size_t>(kHeard_s * samplesPerSecond);
    const auto append = [&](std::vector<double>& to, const std::vector<double>& more) {
        to.insert(to.end(), more.begin(), more.end());
        if (to.size() > kept) to.erase(to.begin(), to.end() - static_cast<std::ptrdiff_t>(kept));
    };
    append(heard0_, block.trigger);
    append(heard1_, block.second);
    if (std::chrono::steady_clock::now() - publishedAt_ < kBetweenNews) return;
    live_.input0 = traceOf(heard0_, samplesPerSecond);
    live_.photodiode = traceOf(heard1_, samplesPerSecond);
    published(false);
}

void Measurer::recorded(const LensRecord& wave) {
    live_.wave = periodOf(wave.power_D, wave.rate, 1.0);
    live_.drive = periodOf(samplesOf(wave.drive, kDrawn), wave.rate, 1e3);
    const auto [low, high] = std::minmax_element(wave.power_D.begin(), wave.power_D.end());
    std::ostringstream name;
    name.precision(2);
    name << std::fixed << *low << " to " << *high << " D";
    live_.waveName = name.str();
}

void Measurer::published(bool now) {
    const auto at = std::chrono::steady_clock::now();
    if (!now && at - publishedAt_ < kBetweenNews) return;
    publishedAt_ = at;
    {
        const std::scoped_lock lock(mutex_);
        news_ = live_;
    }
    if (onNews_) onNews_();
}

}  // namespace ilf::app
