// One measured period: is it one, and what is it at equally spaced times.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ilf::projects {

/// What a table's wave has (scheduling 1.2).
inline constexpr std::size_t kTableSamples = 250;
inline constexpr std::size_t kFewestSamples = 64;

/// Why these times are not one period of `rate_Hz`, and at which sample.
struct NotAPeriod {
    std::size_t sample = 0;
    std::string why;
};
/// Times must increase, and the period they span must be within 0.1 % of 1 / rate: with equal steps the last one
/// included, with unequal ones no gap may be left that is larger than the largest between samples.
std::optional<NotAPeriod> notAPeriod(std::span<const double> time_s, double rate_Hz);

/// Equally spaced from 0 on, to a hundredth of a step.
bool equallySpaced(std::span<const double> time_s, double rate_Hz);

/// Values at kTableSamples equally spaced times from 0 on, through a cubic of the four nearest samples; periodic.
/// Precondition: a period, at least four samples.
std::vector<double> resampled(std::span<const double> time_s, std::span<const double> values, double rate_Hz);

/// Standard deviation of one sample's noise, from third differences: what is smooth does not count. At least 4 samples.
double noiseOf(std::span<const double> values);

/// How far end and start of a period are apart where there is a jump: more than three `noise_D`, half as much again as
/// noise makes it seem anywhere else in the period, and more than 5 mD. Found in what 16 harmonics leave over. At least
/// kFewestSamples.
std::optional<double> jumpAtSeam(std::span<const double> power_D, double noise_D);

}  // namespace ilf::projects
