#include "devices/simulated/lens_emulator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace ilf::devices {
namespace {

constexpr double kPi = std::numbers::pi;

// Static power over current in units of 100 mA at 30 C, and its change for each degree: our own fit to a published
// table of an EL-16-40-TC, rms 0.02 D (scheduling 2; the temperature's last two terms fit its readings at 150 mA).
constexpr std::array kPower{0.51, 6.88, -0.315, -0.441, 0.051, 0.030};
constexpr std::array kPowerPerC{0.034, -0.012, 0.0013, 0.0024};
constexpr double kTable_C = 30.0;

// The membrane's stop: far beyond what any drive reaches on a preset.
constexpr double kStop_D = 60.0;
// A held lens with a loop: swing once round the loop's slip, dying out with this time constant.
constexpr double kSwing_Hz = 50.0, kSwing_s = 0.020;
// A gap longer than this is not played; its last part is, long enough that any preset forgets how it began.
constexpr double kLongest_s = 1.0, kPlayedOfLonger_s = 0.5;
// Below this a step is not worth taking; it is owed.
constexpr double kInstant_s = 1e-12;

template <std::size_t N>
double polynomial(const std::array<double, N>& c, double x) {
    double value = 0.0;
    for (std::size_t i = N; i-- > 0;)
        value = value * x + c[i];
    return value;
}

double tableAt(double current_A, double temperature_C) {
    const double x = 10.0 * current_A;
    return polynomial(kPower, x) + polynomial(kPowerPerC, x) * (temperature_C - kTable_C);
}

/// What a lens could be. Ranges are wider than any preset varied by 20 % by an order of magnitude.
LensParameters possible(LensParameters p) {
    const LensParameters usual;
    const auto within = [](double& value, double low, double high, double otherwise) {
        value = std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
    };
    within(p.dacRate_Hz, 100.0, 1e6, usual.dacRate_Hz);
    within(p.dacStep_V, 0.0, 1.0, 0.0);
    within(p.amplifier_A_per_V, 1e-3, 1e3, usual.amplifier_A_per_V);
    within(p.amplifierPole_s, 1e-6, 1e-2, usual.amplifierPole_s);
    within(p.clip_A, 0.0, 0.29, usual.clip_A);  // where the table ends
    within(p.mode_Hz, 5.0, 500.0, usual.mode_Hz);
    within(p.damping, 0.01, 5.0, usual.damping);
    within(p.stiffnessSquare, 0.0, 0.01, 0.0);
    // Stiffness that falls with deflection would let the lens snap over: b1^2 < 3 b2 keeps its force rising.
    const double most = std::sqrt(2.5 * p.stiffnessSquare);
    within(p.stiffnessLinear, -most, most, 0.0);
    within(p.mode2Ratio, 1.5, 10.0, usual.mode2Ratio);
    within(p.mode2Damping, 0.005, 5.0, usual.mode2Damping);
    within(p.mode2Share, 0.0, 0.5, 0.0);
    within(p.loop_D, 0.0, 2.0, 0.0);
    within(p.slip_D, 0.01, 10.0, usual.slip_D);
    within(p.coil_ohm, 0.0, 100.0, usual.coil_ohm);
    within(p.warming_C_per_W, 0.0, 100.0, usual.warming_C_per_W);
    within(p.warming_s, 1.0, 1e5, usual.warming_s);
    within(p.step_s, 1e-7, 1e-3, usual.step_s);
    // Runge-Kutta of fourth order needs a few steps in each period of the fastest mode.
    p.step_s = std::min(p.step_s, 1.0 / (10.0 * p.mode_Hz * p.mode2Ratio));
    return p;
}

double ambientWithin(double ambient_C, double otherwise) {
    return std::isfinite(ambient_C) ? std::clamp(ambient_C, -40.0, 120.0) : otherwise;
}

/// One step of x'' = acceleration(x, v, force), Runge-Kutta of fourth order; force at its start, middle and end.
template <class Mode, class Acceleration>
void ranOn(Mode& m, double h, const std::array<double, 3>& force, Acceleration acceleration) {
    const double a1 = acceleration(m.x, m.v, force[0]);
    const double v2 = m.v + 0.5 * h * a1;
    const double a2 = acceleration(m.x + 0.5 * h * m.v, v2, force[1]);
    const double v3 = m.v + 0.5 * h * a2;
    const double a3 = acceleration(m.x + 0.5 * h * v2, v3, force[1]);
    const double v4 = m.v + h * a3;
    const double a4 = acceleration(m.x + h * v3, v4, force[2]);
    m.x += h / 6.0 * (m.v + 2.0 * (v2 + v3) + v4);
    m.v += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
    if (std::abs(m.x) < kStop_D) return;
    m.x = std::clamp(m.x, -kStop_D, kStop_D);
    m.v = 0.0;
}

}  // namespace

LensEmulator::LensEmulator(const LensParameters& parameters, double ambient_C)
    : p_(possible(parameters)), ambient_C_(ambientWithin(ambient_C, kTable_C)), coil_C_(ambient_C_) {
    const double tick = 1.0 / p_.dacRate_Hz;
    usual_ = stepOf(tick / std::ceil(tick / p_.step_s));
    const double omega = 2.0 * kPi * p_.mode_Hz;
    first_ = {omega * omega, 2.0 * p_.damping * omega};
    const double omega2 = omega * p_.mode2Ratio;
    second_ = {omega2 * omega2, 2.0 * p_.mode2Damping * omega2};
    table_D_ = tablePower(0.0);
    first_.x = second_.x = table_D_;
}

LensEmulator::Step LensEmulator::stepOf(double length) const {
    const double half = std::exp(-0.5 * length / p_.amplifierPole_s);
    return {length, half * half, half};
}

double LensEmulator::tablePower(double current_A) const { return tableAt(current_A, coil_C_); }

void LensEmulator::play(const Harmonics& drive, Hertz rate, std::optional<double> asAt_C) {
    held_D_.reset();
    driven_A_.reset();
    asAt_C_ = asAt_C && std::isfinite(*asAt_C) ? asAt_C : std::nullopt;
    trimmedFor_C_ = std::numeric_limits<double>::infinity();
    drive_ = isFinite(drive) ? drive : Harmonics{};
    rate_Hz_ = isFinite(rate) && rate > Hertz{} ? rate.si() : 0.0;
    tick_ = -1;
    inTick_s_ = 0.0;
    nextVoltage();
}

void LensEmulator::hold(Dioptre power) {
    const double wanted = isFinite(power) ? std::clamp(power.si(), -kStop_D, kStop_D) : 0.0;
    if (held_D_ == wanted) return;
    held_D_ = wanted;
    driven_A_.reset();
    heldCurrent_A_ = currentFor(wanted);
    heldFor_C_ = coil_C_;
    tick_ = -1;
    inTick_s_ = 0.0;
    nextVoltage();
}

void LensEmulator::drive(Ampere current) {
    held_D_.reset();
    asAt_C_.reset();
    driven_A_ = isFinite(current) ? std::clamp(current.si(), -p_.clip_A, p_.clip_A) : 0.0;
    target_A_ = *driven_A_;
}

void LensEmulator::setAmbient(double ambient_C) { ambient_C_ = ambientWithin(ambient_C, ambient_C_); }

/// The table rises all the way between the clips; a power beyond its ends gets the end.
double LensEmulator::currentFor(double power) const {
    double low = -p_.clip_A, high = p_.clip_A;
    for (int i = 0; i < 48; ++i) {
        const double middle = 0.5 * (low + high);
        (tablePower(middle) < power ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double LensEmulator::driveAt(double x) const {
    const auto& c = drive_.c;
    if (c.size() <= 1) return drive_.mean();
    const double re = std::cos(2.0 * kPi * x), im = std::sin(2.0 * kPi * x);
    // Horner by hand: the library's complex product looks for infinities, and this runs 48000 times a second.
    double real = 0.0, imaginary = 0.0;
    for (std::size_t k = c.size(); k-- > 1;) {
        const double sum = real + c[k].real(), sumI = imaginary + c[k].imag();
        real = sum * re - sumI * im;
        imaginary = sum * im + sumI * re;
    }
    return c[0].real() + real;
}

double LensEmulator::trimmed(double volt) {
    if (!asAt_C_) return volt;
    const double mean_V = drive_.mean();
    if (std::abs(coil_C_ - trimmedFor_C_) > 0.01) {
        const double mean_A = std::clamp(p_.amplifier_A_per_V * mean_V, -p_.clip_A, p_.clip_A);
        trim_V_ = (currentFor(tableAt(mean_A, *asAt_C_)) - mean_A) / p_.amplifier_A_per_V;
        const auto slope = [&](double temperature_C) {
            return tableAt(mean_A + 0.01, temperature_C) - tableAt(mean_A - 0.01, temperature_C);
        };
        swing_ = slope(*asAt_C_) / slope(coil_C_);
        trimmedFor_C_ = coil_C_;
    }
    return mean_V + swing_ * (volt - mean_V) + trim_V_;
}

void LensEmulator::nextVoltage() {
    ++tick_;
    const double t = static_cast<double>(tick_) / p_.dacRate_Hz;
    double volt = 0.0;
    if (held_D_) {
        if (std::abs(coil_C_ - heldFor_C_) > 0.01) {
            heldCurrent_A_ = currentFor(*held_D_);
            heldFor_C_ = coil_C_;
        }
        double current = heldCurrent_A_;
        if (p_.loop_D > 0.0 && t < 20.0 * kSwing_s)
            current += 0.1 / kPower[1] * p_.slip_D * std::exp(-t / kSwing_s) * std::sin(2.0 * kPi * kSwing_Hz * t);
        volt = current / p_.amplifier_A_per_V;
    } else {
        const double x = t * rate_Hz_;
        volt = trimmed(driveAt(x - std::floor(x)));
    }
    if (p_.dacStep_V > 0.0) volt = p_.dacStep_V * std::round(volt / p_.dacStep_V);
    const double wanted = p_.amplifier_A_per_V * volt;
    target_A_ = std::isnan(wanted) ? 0.0 : std::clamp(wanted, -p_.clip_A, p_.clip_A);
}

void LensEmulator::step(const Step& step) {
    const double missing = current_A_ - target_A_;
    const double middle_A = target_A_ + missing * step.halfPole;
    current_A_ = target_A_ + missing * step.pole;
    const std::array table{table_D_, tablePower(middle_A), tablePower(current_A_)};
    table_D_ = table[2];

    const double before = power().si() + p_.loop_D * loop_;
    const double b1 = p_.stiffnessLinear, b2 = p_.stiffnessSquare;
    const auto spring = [b1, b2](double x) { return x * (1.0 + x * (b1 + x * b2)); };
    ranOn(first_, step.length, {spring(table[0]), spring(table[1]), spring(table[2])},
          [this, &spring](double x, double v, double force) {
              return first_.square * (force - spring(x)) - first_.drag * v;
          });
    if (p_.mode2Share > 0.0) {
        ranOn(second_, step.length, table,
              [this](double x, double v, double force) { return second_.square * (force - x) - second_.drag * v; });
    }

    // z' = x'/s - |x'| z/s (Bouc-Wen, n = 1, beta = gamma = 1/2) has a closed form while x rises or falls.
    if (p_.loop_D > 0.0) {
        const double change = power().si() + p_.loop_D * loop_ - before;
        const double end = change < 0.0 ? -1.0 : 1.0;
        loop_ = end + (loop_ - end) * std::exp(-std::abs(change) / p_.slip_D);
    }

    const double warmed = ambient_C_ + p_.warming_C_per_W * p_.coil_ohm * current_A_ * current_A_;
    coil_C_ += (warmed - coil_C_) * (step.length / p_.warming_s);
}

void LensEmulator::advance(Second time) {
    double left = time.si() + owed_s_;
    if (!(time.si() > 0.0)) return;
    if (driven_A_) return advanceDriven(left);
    if (left > kLongest_s) {
        skip(left - kPlayedOfLonger_s);
        left = kPlayedOfLonger_s;
    }
    const double tick = 1.0 / p_.dacRate_Hz;
    while (left > kInstant_s) {
        if (tick - inTick_s_ < kInstant_s) {
            inTick_s_ = 0.0;
            nextVoltage();
        }
        const double done = std::floor(inTick_s_ / usual_.length + 1e-6);
        const double toNext = std::min((done + 1.0) * usual_.length, tick) - inTick_s_;
        const double length = std::min(toNext, left);
        step(std::abs(length - usual_.length) < kInstant_s ? usual_ : stepOf(length));
        inTick_s_ += length;
        left -= length;
    }
    owed_s_ = left;
}

/// Current and membrane are where they stay.
bool LensEmulator::still() const {
    constexpr double kStill_D = 1e-7, kStill_A = 1e-9;
    const double v = std::abs(first_.v) + std::abs(second_.v);
    return std::abs(current_A_ - target_A_) < kStill_A && std::abs(first_.x - table_D_) < kStill_D &&
           std::abs(second_.x - table_D_) < kStill_D && v < kStill_D * std::sqrt(first_.square);
}

void LensEmulator::advanceDriven(double time) {
    owed_s_ = 0.0;
    const double left = std::min(time, kLongest_s);
    // A lens at rest costs nothing but its warmth: the membrane follows the table, which the coil drifts by 1e-3 D a
    // second at most.
    const double end = ambient_C_ + p_.warming_C_per_W * p_.coil_ohm * meanSquareCurrent();
    if (time > left) coil_C_ = end + (coil_C_ - end) * std::exp(-(time - left) / p_.warming_s);
    const int steps = static_cast<int>(std::ceil(left / p_.step_s));
    const Step equal = stepOf(left / std::max(steps, 1));
    for (int i = 0; i < steps; ++i) {
        if (still()) {
            coil_C_ = end + (coil_C_ - end) * std::exp(-(steps - i) * equal.length / p_.warming_s);
            table_D_ = tablePower(current_A_);
            first_.x = second_.x = table_D_;
            first_.v = second_.v = 0.0;
            return;
        }
        step(equal);
    }
}

void LensEmulator::skip(double time) {
    const double gap = std::min(time, 1e7);  // months: nobody knows the phase after that
    const double end = ambient_C_ + p_.warming_C_per_W * p_.coil_ohm * meanSquareCurrent();
    coil_C_ = end + (coil_C_ - end) * std::exp(-gap / p_.warming_s);
    const double total = inTick_s_ + gap;
    const double ticks = std::floor(total * p_.dacRate_Hz);
    tick_ += static_cast<std::int64_t>(ticks) - 1;
    inTick_s_ = std::clamp(total - ticks / p_.dacRate_Hz, 0.0, 1.0 / p_.dacRate_Hz);
    nextVoltage();
}

double LensEmulator::meanSquareCurrent() const {
    if (held_D_) return heldCurrent_A_ * heldCurrent_A_;
    if (driven_A_) return *driven_A_ * *driven_A_;
    constexpr int kPoints = 256;
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i) {
        const double x = rate_Hz_ > 0.0 ? static_cast<double>(i) / kPoints : 0.0;
        const double current = std::clamp(p_.amplifier_A_per_V * driveAt(x), -p_.clip_A, p_.clip_A);
        sum += std::isnan(current) ? 0.0 : current * current;
    }
    return sum / kPoints;
}

void LensEmulator::warmUp() {
    // A held lens needs another current once it is warm; twice is near enough for what a coil of some ohms gains.
    for (int i = 0; i < 2; ++i) {
        coil_C_ = ambient_C_ + p_.warming_C_per_W * p_.coil_ohm * meanSquareCurrent();
        if (held_D_) heldCurrent_A_ = currentFor(*held_D_);
    }
    heldFor_C_ = coil_C_;
}

Dioptre LensEmulator::power() const {
    return Dioptre::fromSi((1.0 - p_.mode2Share) * first_.x + p_.mode2Share * second_.x - p_.loop_D * loop_);
}

DriveLimits LensEmulator::limits() const {
    DriveLimits limits;
    limits.peak = p_.clip_A / p_.amplifier_A_per_V;
    limits.rms = limits.peak / std::numbers::sqrt2;
    return limits;
}

}  // namespace ilf::devices
