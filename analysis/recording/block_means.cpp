#include "analysis/recording/block_means.hpp"

#include <algorithm>
#include <cmath>

namespace gyrolog {
namespace {

// In numbers of the column's data, about an origin so that a sum of many large numbers does not round.
struct BlockSum {
    double sum = 0.0;
    std::size_t known = 0;
};

template <typename T>
BlockSum sum_of(std::span<const T> data, double origin) {
    BlockSum block;
    for (const T number : data) {
        const double value = static_cast<double>(number) - origin;
        if (std::isnan(value)) { continue; }
        block.sum += value;
        ++block.known;
    }
    return block;
}

template <typename T>
double first_known(const std::vector<T>& data) {
    const auto known =
        std::ranges::find_if(data, [](T number) { return !std::isnan(static_cast<double>(number)); });
    return known == data.end() ? 0.0 : static_cast<double>(*known);
}

template <typename T>
std::vector<BlockMean> means_of_data(const std::vector<T>& data, std::span<const Segment> segments,
                                     std::int64_t instants) {
    const double origin = first_known(data);
    std::vector<BlockMean> blocks;
    const std::int64_t begin = segments.front().first_index;
    for (const Segment& segment : segments) {
        const auto count = static_cast<std::int64_t>(segment.count);
        for (std::int64_t i = 0; i < count;) {
            const std::int64_t instant = segment.first_index - begin + i;
            const std::int64_t index = instant / instants;
            const std::int64_t here = std::min((index + 1) * instants - instant, count - i);
            const BlockSum block = sum_of(std::span(data).subspan(segment.first + static_cast<std::size_t>(i),
                                                                  static_cast<std::size_t>(here)),
                                          origin);
            i += here;
            if (block.known == 0) { continue; }
            if (blocks.empty() || blocks.back().index != index) { blocks.push_back({index, 0, 0.0}); }
            blocks.back().samples += block.known;
            blocks.back().mean += block.sum;
        }
    }
    for (BlockMean& block : blocks) { block.mean = origin + block.mean / static_cast<double>(block.samples); }
    return blocks;
}

}  // namespace

std::vector<BlockMean> block_means(const Column& column, std::span<const Segment> segments,
                                   std::int64_t instants) {
    if (segments.empty()) { return {}; }
    std::vector<BlockMean> blocks =
        std::visit([&](const auto& data) { return means_of_data(data, segments, instants); }, column.data);
    for (BlockMean& block : blocks) { block.mean = block.mean * column.scale + column.offset; }
    return blocks;
}

}  // namespace gyrolog
