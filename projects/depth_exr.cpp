// Depth in OpenEXR files: channel Z (its standard name), and our "sigma" beside it.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <cstdint>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <vector>

#include "projects/depth_file.h"
#include "projects/depth_formats.h"
#include "projects/exr_memory.h"
#include "projects/pictures.h"

namespace ilf::projects {

namespace {

constexpr const char* kSigma = "sigma";

/// Z, else Y, else the only channel there is; "": none of these.
std::string depthChannel(const Imf::ChannelList& channels) {
    for (const char* known : {"Z", "Y"}) {
        if (channels.findChannel(known) != nullptr) return known;
    }
    int count = 0;
    std::string name;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel, ++count)
        name = channel.name();
    return count == 1 ? name : "";
}

Imf::Slice sliceOf(float* pixels, int x0, int y0, int width) {
    const std::size_t row = sizeof(float) * static_cast<std::size_t>(width);
    // The library counts from the corner of the data window, wherever that lies.
    char* base = reinterpret_cast<char*>(pixels) - static_cast<std::ptrdiff_t>(x0) * std::ptrdiff_t{sizeof(float)} -
                 static_cast<std::ptrdiff_t>(y0) * static_cast<std::ptrdiff_t>(row);
    return {Imf::FLOAT, base, sizeof(float), row};
}

}  // namespace

bool looksLikeExr(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

Result<DepthPixels> decodeDepthExr(std::string_view bytes, const std::string& name) {
    try {
        ExrReading stream(bytes, name);
        Imf::InputFile file(stream, 0);
        const auto& channels = file.header().channels();
        const std::string channel = depthChannel(channels);
        if (channel.empty()) {
            return fail(Fault::badFile, name + " has no channel of depth: it needs one named Z, or only one.");
        }
        const auto& window = file.header().dataWindow();
        const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
        const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
        if (width <= 0 || height <= 0 || width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) {
            return fail(Fault::badFile, name + " claims more than 100 megapixels: scale it down first.");
        }
        const Size size{static_cast<int>(width), static_cast<int>(height)};
        const auto pixels = static_cast<std::size_t>(width * height);
        std::vector<float> metres(pixels), sigma;
        Imf::FrameBuffer frame;
        frame.insert(channel, sliceOf(metres.data(), window.min.x, window.min.y, size.width));
        if (channels.findChannel(kSigma) != nullptr && channel != kSigma) {
            sigma.resize(pixels);
            frame.insert(kSigma, sliceOf(sigma.data(), window.min.x, window.min.y, size.width));
        }
        file.setFrameBuffer(frame);
        file.readPixels(window.min.y, window.max.y);
        DepthPixels depth{Image<float>(size, 1, std::move(metres)), {}};
        if (!sigma.empty()) depth.sigma = Image<float>(size, 1, std::move(sigma));
        return depth;
    } catch (const std::exception& e) {
        return fail(Fault::badFile, name + " could not be read as EXR: " + e.what() + ". Export it again.");
    }
}

Result<std::string> encodeDepthExr(const Image<float>& metres, const Image<float>& sigma) {
    try {
        Imf::Header header(metres.width(), metres.height());
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer frame;
        // The library reads, and never writes, what it is given here.
        const auto add = [&](const char* name, const Image<float>& image) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            frame.insert(name, sliceOf(const_cast<float*>(image.pixels().data()), 0, 0, image.width()));
        };
        add("Z", metres);
        if (sigma.size() == metres.size() && !sigma.empty()) add(kSigma, sigma);
        ExrBytes stream;
        {
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(frame);
            file.writePixels(metres.height());
        }
        return std::move(stream.bytes);
    } catch (const std::exception& e) {
        return fail(Fault::cannotWrite, std::string("The depth map could not be encoded as EXR: ") + e.what() + ".");
    }
}

}  // namespace ilf::projects
