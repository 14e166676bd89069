#include "app/studio/following_compiler.h"

#include <algorithm>
#include <utility>

namespace ilf::app {

std::vector<std::optional<Second>> lightOfImages(const Plan& plan, const Program& program) {
    std::vector<double> weight(program.images.size(), 0.0), sum_s(program.images.size(), 0.0);
    for (std::size_t s = 0; s < program.imageOfSlot.size() && s < plan.slots.size(); ++s) {
        const int image = program.imageOfSlot[s];
        if (image == Program::kDark) continue;
        const double share = plan.slots[s].duration.si();
        weight[static_cast<std::size_t>(image)] += share;
        sum_s[static_cast<std::size_t>(image)] += share * plan.slots[s].middle().si();
    }
    std::vector<std::optional<Second>> times(program.images.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (weight[i] > 0.0) times[i] = Second::fromSi(sum_s[i] / weight[i]);
    }
    return times;
}

Document FollowingCompiler::placed(const Document& document, std::span<const RegionMove> moves, Second light) {
    if (moves.empty()) return document;
    placed_ = moved(document, motionsAt(moves, light), &placed_);
    return placed_;
}

Result<std::shared_ptr<const Compiled>> FollowingCompiler::one(const Document& document, const Plan& plan) {
    if (last_ && last_->plan == plan && last_->document == document) return last_;
    auto compiled = compile(document, plan, last_.get());
    if (!compiled) return tl::unexpected(compiled.error());
    last_ = std::make_shared<const Compiled>(*std::move(compiled));
    return last_;
}

Result<std::shared_ptr<const Compiled>> FollowingCompiler::compiled(const Document& painted, const Document& document,
                                                                    const Plan& plan,
                                                                    std::span<const RegionMove> moves) {
    const bool same = base_ && base_->plan == plan && base_->document == document && std::ranges::equal(moves_, moves);
    if (same) return shown_;
    auto base = one(document, plan);
    if (!base) return base;
    base_ = *base;
    moves_.assign(moves.begin(), moves.end());
    shown_ = base_;
    if (!anyMoves(moves)) return shown_;
    Compiled together = *base_;
    const auto times = lightOfImages(plan, base_->program);
    Document then = document;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (!times[i]) continue;
        then = moved(painted, motionsAt(moves, *times[i]), &then);
        auto at = one(then, plan);
        if (!at) return at;
        if (i < (*at)->program.images.size()) together.program.images[i] = (*at)->program.images[i];
    }
    shown_ = std::make_shared<const Compiled>(std::move(together));
    return shown_;
}

}  // namespace ilf::app
