// Mutates the values of a JSON text behind its brackets and quotation marks: a byte changed between them
// makes no JSON of it.

#include <iterator>
#include <string>

#include <nlohmann/json.hpp>

#include "tests/fuzz/mutation.hpp"

namespace {

using namespace gyrolog;
using Json = nlohmann::ordered_json;

constexpr std::size_t text_bytes_max = 64;
constexpr std::size_t nodes_max = 100'000;

// With all that is within them; the first is the whole.
void list_nodes(Json& node, std::vector<Json*>& nodes) {
    if (nodes.size() >= nodes_max) { return; }
    nodes.push_back(&node);
    if (!node.is_structured()) { return; }
    for (Json& part : node) { list_nodes(part, nodes); }
}

// Bytes that are no UTF-8 become characters, or no text could be made of them.
std::string changed_text(const std::string& text) {
    Bytes bytes(text.begin(), text.end());
    Mutation::change(bytes, text_bytes_max);
    const Json changed = std::string(bytes.begin(), bytes.end());
    return Json::parse(changed.dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

Json made_value(Mutation& mutation) {
    switch (mutation.below(10)) {
        case 0:
            return nullptr;
        case 1:
            return mutation.one_in(2);
        case 2:
            return Json::array();
        case 3:
            return Json::object();
        case 4:
            return std::string();
        case 5:
            return std::uint64_t{1} << mutation.below(64);
        case 6:
            return -static_cast<std::int64_t>(std::uint64_t{1} << mutation.below(63));
        case 7:
            return 1e308;
        case 8:
            return -5e-324;
        default:
            return static_cast<double>(mutation.below(2000)) / 7.0 - 100.0;
    }
}

void change_value(Mutation& mutation, Json& node) {
    if (node.is_string() && !mutation.one_in(4)) {
        node = changed_text(node.get<std::string>());
    } else if (node.is_number() && mutation.one_in(2)) {
        node = mutation.one_in(2) ? Json(-node.get<double>()) : Json(node.get<double>() * 1e3);
    } else {
        node = made_value(mutation);
    }
}

// A key of an object, or an element of a list: left out, doubled, put under another name, or with a value
// from elsewhere.
void change_parts(Mutation& mutation, Json& node, const Json& from_elsewhere) {
    const std::size_t at = mutation.below(node.size());
    auto part = std::next(node.begin(), static_cast<std::ptrdiff_t>(at));
    const Json value = *part;
    if (mutation.one_in(3)) {
        *part = from_elsewhere;
        return;
    }
    if (node.is_array()) {
        mutation.one_in(2) ? static_cast<void>(node.erase(part)) : node.push_back(value);
        return;
    }
    const std::string other_key = changed_text(part.key());
    if (mutation.one_in(2)) { node.erase(part); }
    if (mutation.one_in(2)) { node[other_key] = value; }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t size_max,
                                               unsigned seed) {
    Mutation mutation(seed);
    if (mutation.is_plain()) { return LLVMFuzzerMutate(data, size, size_max); }
    Json json = Json::parse(data, data + size, nullptr, false);
    if (json.is_discarded()) { return LLVMFuzzerMutate(data, size, size_max); }
    std::vector<Json*> nodes;
    list_nodes(json, nodes);
    for (std::size_t n = 1 + mutation.below(3); n > 0; --n) {
        Json& node = *nodes[mutation.below(nodes.size())];
        const Json elsewhere = *nodes[mutation.below(nodes.size())];
        if (node.is_structured() && !node.empty()) {
            change_parts(mutation, node, elsewhere);
        } else {
            change_value(mutation, node);
        }
        nodes.clear();
        list_nodes(json, nodes);
    }
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return Mutation::hand_back(Bytes(text.begin(), text.end()), data, size, size_max);
}
