#include "render.h"

#include <atomic>
#include <thread>

#include "field.h"

namespace ilf::samples {
namespace {

struct Hit {
    int object = -1;
    float along = 0.0f;
    V3 point{};
};

Hit traced(const Field& field, V3 from, V3 direction, float start, float reach) {
    float t = start;
    for (int i = 0; i < 220 && t < reach; ++i) {
        const V3 p = from + direction * t;
        if (!field.inside(p)) break;
        const auto near = field.nearest(p);
        if (near.distance < 1.0e-4f * std::max(t, 0.3f)) return {near.object, t, p};
        t += near.distance;
    }
    return {};
}

/// 0 in full shadow .. 1 lit, for a light whose half angle has the tangent `spread`.
/// Source: Quilez, "soft shadows in raymarched SDFs" (the improved version, with the inner penumbra).
float lit(const Field& field, V3 from, V3 direction, float reach, float spread) {
    float least = 1.0f, t = 0.002f;
    for (int i = 0; i < 90 && t < reach; ++i) {
        const V3 p = from + direction * t;
        if (!field.inside(p)) break;
        const float d = field.distance(p);
        least = std::min(least, d / (spread * t));
        if (least < -1.0f) return 0.0f;
        t += std::max(0.85f * std::fabs(d), 0.0025f + 0.004f * t);
    }
    least = std::max(least, -1.0f);
    return 0.25f * (1.0f + least) * (1.0f + least) * (2.0f - least);
}

/// 0 buried .. 1 open: how much nearer than expected other surfaces are along the normal.
float openness(const Field& field, V3 p, V3 normal, float reach) {
    float hidden = 0.0f, weight = 1.0f, total = 0.0f;
    for (int i = 1; i <= 6; ++i, weight *= 0.78f) {
        const float step = reach * float(i * i) / 36.0f + 0.0015f;
        hidden += weight * clamp01((step - field.distance(p + normal * step)) / step);
        total += weight;
    }
    return clamp01(1.0f - 1.05f * hidden / total);
}

V3 roomLight(const Scene& scene, V3 direction) {
    // A large soft panel to the upper left, so that metal has something to show.
    const float panel = smoothstep(0.55f, 0.95f, dot(direction, normalized(scene.panel)));
    const float strip = smoothstep(0.93f, 0.99f, dot(direction, normalized({0.9f, 0.35f, 0.2f})));
    return mix(scene.ambientBelow, scene.ambientAbove, 0.5f + 0.5f * direction.y) * 2.0f +
           V3{1.0f, 0.94f, 0.84f} * (1.3f * panel) + V3{0.5f, 0.6f, 0.75f} * strip;
}

class Tracer {
public:
    explicit Tracer(const Scene& scene) : scene_(scene), field_(scene) {}

    Hit hit(V3 from, V3 direction) const { return traced(field_, from, direction, 0.02f, 8.0f); }

    V3 shaded(const Hit& hit, V3 direction, int bounces) const {
        if (hit.object < 0) return roomLight(scene_, direction) * 0.3f;
        const V3 geometric = field_.normal(hit.point, 2.5e-4f * std::max(hit.along, 0.4f));
        const Surface s = scene_.objects[std::size_t(hit.object)].surface(hit.point, geometric);
        const V3 n = normalized(geometric + s.bump);
        const V3 p = hit.point + geometric * 6e-4f;
        const V3 view = -direction;
        const V3 tint = s.metal ? s.albedo * s.gloss : V3{s.gloss, s.gloss, s.gloss};

        V3 diffuse{}, shine{};
        for (const Light& light : scene_.lights) {
            const V3 offset = light.position - p;
            const float away = length(offset);
            const V3 l = offset / away;
            const float facing = dot(n, l);
            if (facing <= 0.0f || dot(geometric, l) <= -0.05f) continue;
            float reach = 1.0f / (away * away);
            if (light.cone > -1.0f)
                reach *= smoothstep(light.cone, mix(light.cone, 1.0f, 0.65f),
                                    dot(-l, normalized(light.towards - light.position)));
            if (reach < 1e-3f) continue;
            if (light.shadows) reach *= lit(field_, p, l, away, light.radius / away);
            const V3 arriving = light.power * reach;
            diffuse = diffuse + arriving * facing;
            // Blinn-Phong lobe, normalised, as wide as the roughness asks.
            const float power = 2.0f / std::max(s.roughness * s.roughness * s.roughness * s.roughness, 2e-4f);
            const float peak = std::pow(std::max(dot(n, normalized(l + view)), 0.0f), power) * (power + 8.0f) / 25.0f;
            shine = shine + arriving * (std::min(peak, 30.0f) * facing);
        }

        const float open = openness(field_, p, n, scene_.occlusionReach);
        // Light that bounced once between near surfaces comes back in their own colour (after Jimenez et al. 2016,
        // "Practical realtime strategies for accurate indirect occlusion").
        const auto bounced = [&](float a) {
            return std::max(
                open, ((open * (2.0404f * a - 0.3324f) + 0.6417f - 4.7951f * a) * open + 2.7552f * a + 0.6903f) * open);
        };
        const V3 reopened{bounced(s.albedo.x), bounced(s.albedo.y), bounced(s.albedo.z)};
        const V3 ambient = mix(scene_.ambientBelow, scene_.ambientAbove, 0.5f + 0.5f * n.y) * reopened;

        V3 colour = s.metal ? V3{} : s.albedo * (diffuse + ambient);
        colour = colour + tint * shine + s.albedo * s.glow;
        if (s.gloss > 0.0f) {
            const float grazing = std::pow(1.0f - std::max(dot(n, view), 0.0f), 5.0f) * (1.0f - s.roughness);
            const V3 fresnel = mix(tint, V3{1.0f, 1.0f, 1.0f}, grazing * (s.metal ? 0.5f : 0.7f));
            const V3 mirror = direction - n * (2.0f * dot(n, direction));
            // Only polished things pay for a ray; the rest reflects the room, dimmed where it is hidden.
            const float sharp = smoothstep(0.45f, 0.2f, s.roughness);
            V3 seen = roomLight(scene_, mirror) * (0.35f + 0.65f * open) * open * (1.0f - 0.75f * s.roughness);
            if (sharp > 0.0f && bounces > 0) {
                const Hit next = traced(field_, p, mirror, 0.004f, 4.0f);
                if (next.object >= 0) seen = mix(seen, shaded(next, mirror, bounces - 1), sharp);
            }
            colour = colour + fresnel * seen;
        }
        return colour;
    }

private:
    const Scene& scene_;
    Field field_;
};

/// Linear to sRGB, 0..1; highlights roll off above 0.8 so that nothing clips hard.
V3 encoded(V3 c) {
    const auto one = [](float x) {
        if (x > 0.8f) x = 0.8f + 0.2f * (1.0f - std::exp(-(x - 0.8f) / 0.2f));
        return x <= 0.0031308f ? 12.92f * std::max(x, 0.0f) : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
    };
    return {one(c.x), one(c.y), one(c.z)};
}

template <class Row>
void eachRow(int rows, const Row& row) {
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int y = next++; y < rows; y = next++)
            row(y);
    };
    std::jthread other(work);
    work();
}

struct Sample {
    V3 colour{};
    int object = -1;
    float depth = 0.0f;
};

}  // namespace

Rendering rendered(const Scene& scene, int samplesAcross) {
    const int w = scene.camera.width, h = scene.camera.height;
    const V3 forward = normalized(scene.camera.target - scene.camera.eye);
    const V3 right = normalized(cross(forward, {0.0f, 1.0f, 0.0f})), up = cross(right, forward);
    const float focal = 0.5f * float(w) / std::tan(0.5f * scene.camera.across);
    const Tracer tracer(scene);
    const auto sampled = [&](float x, float y) {
        const V3 ray = forward + right * ((x - 0.5f * float(w)) / focal) - up * ((y - 0.5f * float(h)) / focal);
        const V3 direction = normalized(ray);
        const Hit hit = tracer.hit(scene.camera.eye, direction);
        const V3 colour = encoded(tracer.shaded(hit, direction, 1) * scene.exposure);
        return Sample{colour, hit.object, hit.object < 0 ? 0.0f : hit.along * dot(direction, forward) - kLensToPupil};
    };
    const auto at = [&](int x, int y) { return std::size_t(y) * std::size_t(w) + std::size_t(x); };

    std::vector<Sample> centres(std::size_t(w) * std::size_t(h));
    eachRow(h, [&](int y) {
        for (int x = 0; x < w; ++x)
            centres[at(x, y)] = sampled(float(x) + 0.5f, float(y) + 0.5f);
    });

    const auto rough = [&](int x, int y) {
        const Sample& me = centres[at(x, y)];
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, h - 1); ++j)
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, w - 1); ++i) {
                const Sample& other = centres[at(i, j)];
                const V3 difference = absolute(other.colour - me.colour);
                if (other.object != me.object || std::fabs(other.depth - me.depth) > 0.02f * me.depth ||
                    std::max({difference.x, difference.y, difference.z}) > 0.025f)
                    return true;
            }
        return false;
    };

    Rendering out{w, h, std::vector<std::uint8_t>(centres.size() * 3), std::vector<float>(centres.size()), {}};
    std::vector<std::vector<std::uint8_t>*> maskOf(scene.objects.size(), nullptr);
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        if (const std::string& region = scene.objects[i].region; !region.empty()) {
            auto& mask = out.masks[region];
            mask.resize(centres.size());
            maskOf[i] = &mask;
        }
    eachRow(h, [&](int y) {
        for (int x = 0; x < w; ++x) {
            const int n = rough(x, y) ? samplesAcross : 1;
            V3 sum{};
            std::map<std::vector<std::uint8_t>*, int> counts;
            for (int k = 0; k < n * n; ++k) {
                const bool centre = n % 2 == 1 && k == n * n / 2;
                const Sample s = centre ? centres[at(x, y)]
                                        : sampled(float(x) + (float(k % n) + 0.5f) / float(n),
                                                  float(y) + (float(k / n) + 0.5f) / float(n));
                sum = sum + s.colour;
                if (s.object >= 0) ++counts[maskOf[std::size_t(s.object)]];
            }
            const V3 mean = sum / float(n * n) * 255.0f;
            const std::size_t pixel = at(x, y);
            out.picture[3 * pixel] = std::uint8_t(mean.x + 0.5f);
            out.picture[3 * pixel + 1] = std::uint8_t(mean.y + 0.5f);
            out.picture[3 * pixel + 2] = std::uint8_t(mean.z + 0.5f);
            out.depth[pixel] = centres[pixel].depth;
            for (const auto& [mask, count] : counts)
                if (mask != nullptr) (*mask)[pixel] = std::uint8_t((255 * count + n * n / 2) / (n * n));
        }
    });
    return out;
}

}  // namespace ilf::samples
