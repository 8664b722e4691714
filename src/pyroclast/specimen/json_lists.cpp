#include "pyroclast/specimen/json_lists.hpp"

#include <limits>
#include <string_view>

namespace pyroclast::specimen {

int number_in(const Json& item) {
  if (const double value = item.get<double>();
      !item.is_number_integer() || value < 0 || value > std::numeric_limits<int>::max())
    throw Json::other_error::create(501, "no number from 0", &item);
  return item.get<int>();
}

int number_or_none_in(const Json& item) {
  return item.is_number_integer() && item == -1 ? -1 : number_in(item);
}

double real_in(const Json& item) {
  return item.get<double>();
}

std::vector<int> numbers_in(const Json& items) {
  std::vector<int> all;
  for (const Json& item : items.get_ref<const Json::array_t&>()) all.push_back(number_in(item));
  return all;
}

std::string text_in(const Json& item) {
  return item.get<std::string>();
}

void read_table(const std::string& text, const std::string& name,
                const std::function<void(const Json&)>& read) {
  try {
    const Json json = Json::parse(text);
    if (!json.is_object()) throw Error("is no table of lists");
    read(json);
  } catch (const Json::parse_error& error) {
    throw Error(fmt::format(
        "{}: is not JSON, at byte {}: blocks made elsewhere come as JSON, to which the Python package turns "
        "arrays, meshes and images of the plane",
        name, error.byte));
  } catch (const Json::out_of_range& error) {  // the text is "[...] number overflow parsing '1e999'"
    const std::string_view what = error.what();
    throw Error(fmt::format("{}: {}", name, what.substr(what.find(']') + 2)));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace pyroclast::specimen
