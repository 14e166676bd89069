// A lens's power as a linear function of its drive about where it was last seen, corrected by every record.
#pragma once

#include "core/lens/record.h"
#include "core/lens/shaped_wave.h"

namespace ilf {

/// power = rest + sum over j of x_j slopes[j], where x lists the drive's mean, then real and imaginary part of each
/// harmonic. A lens that is not linear answers a harmonic with others as well: a slope is a whole wave.
struct PowerModel {
    Hertz rate;
    DriveUnit unit = DriveUnit::volt;
    Harmonics rest;
    std::vector<Harmonics> slopes;

    std::size_t harmonics() const { return (slopes.size() - 1) / 2; }
    Harmonics power(const Harmonics& drive) const;
};

/// As the response says, for drives of at most `harmonics` harmonics.
PowerModel modelOf(const LensResponse& response, std::size_t harmonics);

/// Real unknowns of a drive, and back. `harmonics` of them, zeros where the drive has fewer.
std::vector<double> unknownsOf(const Harmonics& drive, std::size_t harmonics);
Harmonics driveOf(std::span<const double> unknowns);

/// Goes through `power` at `drive` from now on; slopes stay.
void moveTo(PowerModel& model, const Harmonics& drive, const Harmonics& power);
/// Broyden's correction: the slopes change the least (weighed by the power they stand for) that makes the model agree
/// with how the power changed from one drive to another. Changes near the noise of a record correct little.
void correct(PowerModel& model, const Harmonics& driveChange, const Harmonics& powerChange, double noise_D);

/// A response, and the last of the records it was found with: the wave it asks for, next to where learning begins.
struct Identification {
    LensResponse response;
    Harmonics drive, power;
};
/// Two weak multisines, then one with the spectrum of the wave that is to hold `holds`.
Result<Identification> identifiedFor(const RecordLens& record, Hertz rate, std::span<const Hold> holds, int harmonics,
                                     const DriveLimits& limits);

Result<ShapedDesign> designed(const PowerModel& model, std::span<const Hold> holds, const DriveLimits& limits);

}  // namespace ilf
