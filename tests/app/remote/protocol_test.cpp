// Lines of clients: their meaning, and the words of refusals.
#include "app/remote/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limpid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Request read(std::string_view line) {
  json id;
  return read_request(line, id);
}

std::string refusal(std::string_view line) {
  json id;
  try {
    read_request(line, id);
  } catch (const RemoteError& e) {
    return e.what();
  }
  return "";
}

TEST(Protocol, ReadsIdVerbAndKeys) {
  const Request request = read(R"({"id": 1, "do": "set", "values": {"coupling.eta": 0.5}})");
  EXPECT_EQ(request.id, json(1));
  EXPECT_STREQ(request.verb->name, "set");
  EXPECT_EQ(request.keys, json({{"values", {{"coupling.eta", 0.5}}}}));
  EXPECT_EQ(read(R"({"do":"hello"})").id, json());
  EXPECT_EQ(read(R"({"do":"hello","id":"a"})").id, json("a"));
}

TEST(Protocol, AnswersCarryTheId) {
  EXPECT_EQ(json::parse(answer_line(1, {{"a", 2}})), json({{"id", 1}, {"ok", {{"a", 2}}}}));
  EXPECT_EQ(json::parse(error_line("x", "no")), json({{"id", "x"}, {"error", "no"}}));
  EXPECT_EQ(answer_line(1, json::object()).find('\n'), std::string::npos);
}

TEST(Protocol, RefusesWhatIsNoObject) {
  for (const char* line : {"", "{", "1", "[]", "null", "{}x", "{\"do\":\"hello\"}{}", "\xFF\xFE",
                           "{'do': 'hello'}", "{\"do\": NaN}"}) {
    EXPECT_THAT(refusal(line), HasSubstr("one JSON object")) << line;
  }
}

TEST(Protocol, NamesWhatWasFoundAndWhatIsAllowed) {
  EXPECT_THAT(refusal(R"({"id":3})"), HasSubstr("do: is missing; allowed: hello, get, set"));
  EXPECT_THAT(refusal(R"({"do":"arm"})"), HasSubstr(R"(do: "arm" is not known; allowed: hello)"));
  EXPECT_THAT(refusal(R"({"do":3})"), HasSubstr("do: 3 is not known"));
  EXPECT_THAT(refusal(R"({"do":"cut","now":1})"),
              HasSubstr(R"(cut: "now" is not a key of this command; allowed: none)"));
  EXPECT_THAT(refusal(R"({"do":"hello","id":1.5})"), HasSubstr("id: 1.5 is not allowed"));
  const std::string longest(65, 'x');
  EXPECT_THAT(refusal(R"({"do":"hello","id":")" + longest + "\"}"), HasSubstr("up to 64"));
}

TEST(Protocol, KeepsTheIdOfARequestThatIsRefused) {
  json id;
  EXPECT_THROW(read_request(R"({"id": 9, "do": "dance"})", id), RemoteError);
  EXPECT_EQ(id, json(9));
}

TEST(Protocol, RefusesWhatIsNestedDeepWithoutGoingDeepItself) {
  std::string line = R"({"do":"set","values":)";
  for (int i = 0; i < 30'000; ++i) line += "[";
  EXPECT_THAT(refusal(line), HasSubstr("deep"));
  EXPECT_EQ(refusal(R"({"do":"set","values":{"a":[[[1]]]}})"), "");
}

TEST(Protocol, ShowsLittleOfWhatItRefuses) {
  const std::string line = R"({"do":")" + std::string(60'000, 'x') + "\"}";
  EXPECT_LT(refusal(line).size(), 400u);
}

TEST(Protocol, HearsACutWhateverElseTheLineSays) {
  EXPECT_TRUE(asks_for_cut(R"({"do":"cut"})"));
  EXPECT_TRUE(asks_for_cut(R"({"id":[1],"do":"cut","now":true})"));
  EXPECT_FALSE(asks_for_cut(R"({"do":"mark","text":"cut"})"));
  EXPECT_FALSE(asks_for_cut("cut"));
  EXPECT_FALSE(asks_for_cut(R"(["cut"])"));
}

TEST(Protocol, WritesNoNumberAsNullAndNoTextAsSuch) {
  EXPECT_EQ(json_line(std::nan("")), "null");
  EXPECT_NO_THROW(json_line("\xFF"));
}

TEST(Keys, AreReadWithinTheirBounds) {
  const Request request = read(R"({"do":"follow","channels":["a","b"],"rate":50})");
  const Keys keys(request);
  EXPECT_EQ(keys.number_or("rate", 1, 0, 100), 50);
  EXPECT_EQ(keys.number_or("none", 1, 0, 100), 1);
  EXPECT_THROW(keys.number_or("rate", 1, 0, 10), RemoteError);
  EXPECT_EQ(keys.texts_if("channels", 2), (std::vector<std::string>{"a", "b"}));
  EXPECT_THROW(keys.texts_if("channels", 1), RemoteError);
  EXPECT_THROW(keys.text("channels"), RemoteError);
  EXPECT_THROW(keys.flag_or("rate", true), RemoteError);
  EXPECT_EQ(keys.texts_if("none", 1), std::nullopt);
}

TEST(Keys, RefuseTextsThatAreEmptyTooLongOrHoldZeros) {
  for (const std::string& text :
       {std::string(), std::string(4001, 'x'), std::string("a\\u0000b")}) {
    const Request request = read(R"({"do":"mark","text":")" + text + "\"}");
    EXPECT_THROW(Keys(request).text("text"), RemoteError) << text.substr(0, 10);
  }
}

}  // namespace
}  // namespace limpid
