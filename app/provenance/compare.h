// Where two products part, in words. Each returns an empty text when they are equal.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/support/build_info.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct Scenario;

// A member that two products have differently, or one of them alone: "not there". Values: JSON, cut after 80 characters.
struct Difference {
  std::string path;  // "pile.mix[1].weight"
  std::string was, is;
};
std::vector<Difference> list_differences(const nlohmann::ordered_json& was, const nlohmann::ordered_json& is);
std::vector<Difference> list_differences(const Scenario& was, const Scenario& is);

// "pile.layers is 3 instead of 2": the first difference.
std::string describe_difference(const nlohmann::ordered_json& was,
                                const nlohmann::ordered_json& is);

// "piece 17 (brick) is the first that differs, in its position x: ..."
std::string describe_difference(const PileState& was, const PileState& is);

// Eight hexadecimal digits over the state of each piece, one after another; and the first piece of `is`
// whose digits are not among `was` at its place, in words. Empty: they are equal.
std::string digest_pieces(const PileState& pile);
std::string describe_first_piece(const std::string& was, const PileState& is);

// "byte 4711 is the first that differs: 0x1f instead of 0x20", or by their sizes. Throws RunError
// when one cannot be read.
std::string describe_difference_of_files(const std::string& was, const std::string& is);

// "version 0.2 instead of 0.1"; one line for each member that differs.
std::vector<std::string> describe_differences(const BuildInfo& was, const BuildInfo& is);

}  // namespace rubble
