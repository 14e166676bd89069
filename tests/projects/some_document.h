// Documents for tests: one with everything in it, and random ones.
#pragma once

#include <rapidcheck.h>

#include "core/document/edit.h"

namespace ilf {

inline Mask speckled(Size size, std::uint32_t seed) {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    for (auto& v : pixels) {
        seed = seed * 1664525U + 1013904223U;
        v = static_cast<std::uint8_t>((seed >> 28) < 9 ? 0 : seed >> 24);
    }
    return toTiles(Image<std::uint8_t>(size, 1, std::move(pixels)));
}

inline Picture noisePicture(Size size, std::uint32_t seed, bool sixteenBits) {
    std::vector<std::uint16_t> pixels(3 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    for (auto& v : pixels) {
        seed = seed * 1664525U + 1013904223U;
        v = static_cast<std::uint16_t>(sixteenBits ? seed >> 16 : (seed >> 24) * 257);
    }
    return Picture(size, 3, std::move(pixels));
}

/// One of everything a project can hold, over a small picture.
inline Document fullDocument(Size size = {96, 70}) {
    Scene scene;
    scene.picture = Box<Picture>(noisePicture(size, 7, false));
    scene.source = "desk.png";
    scene.camera = {"usb-camera-1", {1280, 1024}, 40, 20, 2, size};
    scene.scale = {1234.5, PixelScale::Source::typed};
    std::vector<std::uint16_t> raw(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), 900);
    raw[5] = 0;
    scene.depth = Box<DepthMap>(depthOf(Image<std::uint16_t>(size, 1, std::move(raw)), 0.5_mm));
    Document document = newDocument(std::move(scene));
    document.name = "Desk \xE9\xAB\x98";  // U+9AD8 in UTF-8
    Region face;
    face.id = "2f1c6e0a-face";
    face.name = "Face";
    face.look = Look::blur;
    face.strength = 1.25_D;
    face.distance = ConstantDistance{0.25_m, 0.01_m};
    face.mask = speckled(size, 1);
    face.locked = true;
    Region slope;
    slope.id = "Slope/..\\ \xC3\xA4";
    slope.name = "Slope";
    slope.distance = PlaneDistance{{DistanceAnchor{{1.5, 2.5}, 0.4_m}, {{90.5, 3.0}, 0.5_m}, {{4.0, 60.0}, 0.7_m}}};
    slope.mask = speckled(size, 2);
    slope.outline = Outline{{{1.0, 1.0}, {50.25, 2.0}, {30.0, 60.125}}};
    slope.solo = true;
    Region hands;
    hands.id = std::string(300, 'h');
    hands.name = "Hands";
    hands.look = Look::neutral;
    hands.distance = FromDepthMap{0.02_m};
    hands.mask = Mask(size);
    hands.visible = false;
    document.regions = {Box<Region>(face), Box<Region>(slope), Box<Region>(hands)};
    Region background = *document.background;
    background.look = Look::blur;
    background.distance = ConstantDistance{1.3_m, 0.0_m};
    document.background = Box<Region>(background);
    document.seam = {Blending::linearPerceived, 7.5_mm};
    document.alpha = 0.3_D;
    document.wearer.name = "Grandmother";
    document.wearer.ageYears = 71.0;
    document.wearer.measuredAccommodation = 0.5_D;
    document.wearer.confusion = {CircleOfConfusion::Preset::typed, 21.0_um};
    document.wearer.camera = CameraObserver{};
    document.rig.registration =
        registered(Homography<ProjectorFrame, CameraFrame>{{1.1, 0.01, 3, -0.02, 0.9, 4, 1e-5, 2e-5, 1}});
    return document;
}

/// The same with what version 2 added: measured depth with its uncertainty, a wearer beside the camera, a fitted
/// plane's tolerance, and regions that follow.
inline Document measuredDocument(Size size = {96, 70}, bool withSigma = true) {
    Document document = fullDocument(size);
    MeasuredDepth measured;
    std::vector<float> metres, sigma;
    for (int i = 0; i < size.width * size.height; ++i) {
        metres.push_back(i % 50 == 0 ? 0.0F : static_cast<float>((800 + i % 97) * 0.0005));
        sigma.push_back(i % 50 == 0 ? 0.0F : 0.001F * static_cast<float>(1 + i % 3));
    }
    measured.metres = Image<float>(size, 1, std::move(metres));
    if (withSigma) measured.sigma = Image<float>(size, 1, std::move(sigma));
    measured.camera = {size, 90.5, 91.25, 47.0, 36.5, {-0.1, 0.01, 0.001, -0.002, 0.0}};
    measured.step = 0.5_mm;
    measured.source = "depth camera";
    measured.provenance = "measured";
    ViewerPose viewer;
    viewer.viewerFromCamera.rotation = {0.6, 0, 0.8, 0, 1, 0, -0.8, 0, 0.6};
    viewer.viewerFromCamera.translation = {0.05, -0.1, 0.3};
    viewer.sigma = 2.0_mm;
    viewer.source = "typed";
    document = *edited(document, SetViewerPose{viewer});
    document = *edited(document, SetMeasuredDepth{Box<MeasuredDepth>(measured)});
    const auto follow = [&](std::size_t index, const Follow& what) {
        Region region = *document.regions[index];
        region.follow = what;
        document.regions[index] = Box<Region>(region);
    };
    follow(0, {MarkerTarget{"6X6_250", 7}, Follow::WhenLost::blur, 200.0_ms, 1000.0_ms});
    follow(1, {PlanarTarget{{3, 4, 40, 50}}, Follow::WhenLost::focus, 0.0_ms, 50.0_ms});
    follow(2, {StreamTarget{"/pose/hand"}, Follow::WhenLost::neutral, 500.0_ms, 500.0_ms});
    Region slope = *document.regions[1];
    std::get<PlaneDistance>(slope.distance).tolerance = 3.0_mm;
    document.regions[1] = Box<Region>(slope);
    return document;
}

/// A document an operator could have made.
inline Document randomDocument() {
    using namespace rc;
    const auto number = [](double low, double high) { return low + (high - low) * *gen::inRange(0, 1000001) / 1e6; };
    const Size size{*gen::inRange(1, 90), *gen::inRange(1, 90)};
    Scene scene;
    scene.picture = Box<Picture>(noisePicture(size, *gen::arbitrary<std::uint32_t>(), *gen::arbitrary<bool>()));
    scene.source = *gen::element<std::string>("", "a.png", "/dev/v4l/by-id/usb-x", "\xE9\xAB\x98.jpg");
    scene.scale = {focalPixels(size.width, number(1.0, 170.0)), static_cast<PixelScale::Source>(*gen::inRange(0, 4))};
    Document document = newDocument(std::move(scene));
    document.name = *gen::element<std::string>("x", "Museum \"guide\"", "\xC3\xA4");
    const auto distance = [&]() -> Distance {
        if (*gen::arbitrary<bool>()) {
            const double value = number(0.05, 10.0);
            return ConstantDistance{Metre::fromSi(value), Metre::fromSi(number(0.0, 0.5) * value)};
        }
        return PlaneDistance{{DistanceAnchor{{0.0, number(0.0, 1.0)}, Metre::fromSi(number(0.1, 2.0))},
                              {{number(50.0, 99.0), 0.0}, Metre::fromSi(number(0.1, 2.0))},
                              {{number(0.0, 9.0), 70.0}, Metre::fromSi(number(0.1, 2.0))}}};
    };
    const int count = *gen::inRange(0, 4);
    for (int i = 0; i < count; ++i) {
        Region region;
        region.id = *gen::element<std::string>("face", "Face", "a/b", "..", "CON", "\xC3\xA4") + std::to_string(i);
        region.name = "Region " + std::to_string(i);
        region.look = static_cast<Look>(*gen::inRange(0, 3));
        if (*gen::arbitrary<bool>()) region.strength = Dioptre::fromSi(number(0.0, 3.0));
        region.distance = distance();
        region.mask = speckled(size, *gen::arbitrary<std::uint32_t>());
        if (*gen::arbitrary<bool>()) {
            region.outline = Outline{{{number(0, 9), number(0, 9)}, {number(0, 90), 1.0}, {2.0, number(0, 90)}}};
        }
        region.visible = *gen::arbitrary<bool>();
        region.locked = *gen::arbitrary<bool>();
        region.solo = *gen::arbitrary<bool>();
        document.regions.emplace_back(std::move(region));
    }
    document.seam = {static_cast<Blending>(*gen::inRange(0, 4)), Metre::fromSi(number(0.001, 0.03))};
    document.alpha = Dioptre::fromSi(number(0.0, 1.0));
    document.wearer.pupil = Metre::fromSi(number(0.002, 0.007));
    document.wearer.ametropia = Dioptre::fromSi(number(-5.0, 3.0));
    document.rig.projectorDelay = Second::fromSi(number(0.0, 0.0009));
    return document;
}

}  // namespace ilf
