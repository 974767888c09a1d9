// Runs a libFuzzer target without libFuzzer: every file of the folders named as arguments, then inputs made
// from them and from a fixed seed. The same inputs each time, so that a failure here is a failure everywhere;
// the hunt for new ones is the clang build's.
//
// GYROLOG_FUZZ_INPUTS sets the number of made inputs (20000).

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
// Of a target that knows its format: makes half of the changes.
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                                                     std::size_t size_max, unsigned seed);

namespace {

using Input = std::vector<std::uint8_t>;

constexpr unsigned seed = 20'260'101;
constexpr std::size_t size_max = 8192;
// A slow target ends here instead of at its count; it says so.
constexpr std::chrono::seconds time_max{10};

std::vector<Input> read_corpus(int count, char** folders) {
    std::vector<std::filesystem::path> paths;
    for (int i = 0; i < count; ++i) {
        if (!std::filesystem::is_directory(folders[i])) { continue; }
        for (const auto& entry : std::filesystem::directory_iterator(folders[i])) {
            if (entry.is_regular_file()) { paths.push_back(entry.path()); }
        }
    }
    std::sort(paths.begin(), paths.end());  // the folder's own order differs from machine to machine
    std::vector<Input> corpus;
    for (const std::filesystem::path& path : paths) {
        std::ifstream file(path, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    return corpus;
}

class Mutator {
public:
    explicit Mutator(const std::vector<Input>& corpus) : corpus_(corpus) {}

    Input next() {
        Input input = below(8) == 0 ? noise() : some_of_the_corpus();
        for (std::size_t n = below(6); n > 0; --n) {
            if (LLVMFuzzerCustomMutator != nullptr && below(2) == 0) {
                mutate_by_format(input);
            } else {
                mutate(input);
            }
        }
        if (input.size() > size_max) { input.resize(size_max); }
        return input;
    }

    void mutate(Input& input);

private:
    void mutate_by_format(Input& input) {
        const std::size_t size = std::min(input.size(), size_max);
        input.resize(size_max);
        input.resize(LLVMFuzzerCustomMutator(input.data(), size, size_max, static_cast<unsigned>(random_())));
    }

    std::size_t below(std::size_t limit) { return random_() % limit; }
    std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }

    Input noise() {
        Input input(below(300));
        for (std::uint8_t& value : input) { value = byte(); }
        return input;
    }

    Input some_of_the_corpus() { return corpus_.empty() ? noise() : corpus_[below(corpus_.size())]; }

    static constexpr std::uint8_t interesting[] = {0x00, 0x01, 0x7F, 0x80, 0xFE, 0xFF};
    const std::vector<Input>& corpus_;
    std::mt19937 random_{seed};
};

void Mutator::mutate(Input& input) {
    if (input.empty()) {
        input.push_back(byte());
        return;
    }
    const auto at = input.begin() + static_cast<std::ptrdiff_t>(below(input.size()));
    const auto left = static_cast<std::size_t>(input.end() - at);
    const auto run = static_cast<std::ptrdiff_t>(1 + below(std::min<std::size_t>(left, 64)));
    switch (below(7)) {
        case 0:
            *at ^= static_cast<std::uint8_t>(1U << below(8));
            break;
        case 1:
            *at = byte();
            break;
        case 2:
            *at = interesting[below(std::size(interesting))];
            break;
        case 3:
            input.erase(at, at + run);
            break;
        case 4:
            std::fill(at, at + run, std::uint8_t{0});
            break;
        case 5: {
            const Input again(at, at + run);
            input.insert(at, again.begin(), again.end());
            break;
        }
        default: {
            const Input other = some_of_the_corpus();
            input.insert(at, other.begin(), other.end());
            break;
        }
    }
}

// The one that LLVMFuzzerMutate asks; set while there is one.
Mutator* present = nullptr;

std::size_t inputs_wanted() {
    const char* text = std::getenv("GYROLOG_FUZZ_INPUTS");
    return text != nullptr ? std::strtoul(text, nullptr, 10) : 20'000;
}

}  // namespace

// As libFuzzer gives it to a target's own mutator.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t limit) {
    Input input(data, data + size);
    present->mutate(input);
    input.resize(std::min(input.size(), limit));
    std::copy(input.begin(), input.end(), data);
    return input.size();
}

int main(int argc, char** argv) {
    const std::vector<Input> corpus = read_corpus(argc - 1, argv + 1);
    for (const Input& input : corpus) { LLVMFuzzerTestOneInput(input.data(), input.size()); }
    std::printf("%zu files; made inputs from seed %u\n", corpus.size(), seed);

    const auto begin = std::chrono::steady_clock::now();
    Mutator mutator(corpus);
    present = &mutator;
    const std::size_t wanted = inputs_wanted();
    std::size_t done = 0;
    for (; done < wanted && std::chrono::steady_clock::now() - begin < time_max; ++done) {
        const Input input = mutator.next();
        LLVMFuzzerTestOneInput(input.data(), input.size());
    }
    std::printf("%zu of %zu made inputs run%s\n", done, wanted, done < wanted ? ": out of time" : "");
    return 0;
}
