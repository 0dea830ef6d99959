// Lines of clients: their meaning, and the words of refusals.
#include "app/remote/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "tests/support/temp_dir.h"

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

TEST(Protocol, ShowsTheBeginningOfWhatIsLong) {
  EXPECT_EQ(shown(json({{"a", 1}})), R"({"a":1})");
  EXPECT_EQ(shown(std::string(58, 'x')), "\"" + std::string(58, 'x') + "\"") << "60 characters";
  EXPECT_EQ(shown(std::string(59, 'x')), "\"" + std::string(59, 'x') + "...");
  const std::string line = "{" + std::string(100, 'y');
  EXPECT_THAT(refusal(line), testing::EndsWith("found: {" + std::string(59, 'y')));
  EXPECT_THAT(refusal("{\t\x7F"), testing::EndsWith("found: {??")) << "what no terminal should get";
  EXPECT_THAT(refusal("[1,2]"), testing::EndsWith("one JSON object; found: [1,2]"));
}

TEST(Protocol, ListsEveryVerbWithItsHelpAndItsKeys) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs()) {
    names.emplace_back(verb.name);
    EXPECT_EQ(find_verb(verb.name), &verb);
    EXPECT_GT(std::string(verb.help).size(), 10u) << verb.name;
    // Each key is taken, and one that is none is refused with the list of all.
    json request{{"do", verb.name}};
    std::string all;
    for (const char* key : verb.keys) {
      request[key] = 1;
      all += (all.empty() ? "" : ", ") + std::string(key);
    }
    EXPECT_EQ(refusal(request.dump()), "") << verb.name;
    request["no_key"] = 1;
    EXPECT_EQ(refusal(request.dump()), std::string(verb.name) +
                                           ": \"no_key\" is not a key of this command; allowed: " +
                                           (all.empty() ? "none" : all));
  }
  EXPECT_EQ(names, (std::vector<std::string>{"hello", "get", "set", "open", "record", "stop",
                                             "start_over", "mark", "row", "follow", "twin", "blind",
                                             "ask", "picture", "cut", "bye"}));
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  EXPECT_THAT(refusal(R"({"do":"dance"})"), testing::EndsWith("allowed: " + list));
  EXPECT_EQ(find_verb("dance"), nullptr);
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

std::string complaint(const std::string& line, const std::function<void(const Keys&)>& reads) {
  const Request request = read(line);
  try {
    reads(Keys(request));
  } catch (const RemoteError& error) {
    return error.what();
  }
  return "none";
}

TEST(Keys, SayWhichOneIsWrongAndWhatIsAllowed) {
  const std::string mark = R"({"do":"mark","text":7})";
  EXPECT_EQ(complaint(mark, [](const Keys& keys) { keys.text("text"); }),
            "mark: text: 7 is not allowed; allowed: a text");
  EXPECT_EQ(complaint(R"({"do":"mark"})", [](const Keys& keys) { keys.text("text"); }),
            "mark: text: is missing");
  EXPECT_EQ(complaint(R"({"do":"mark"})", [](const Keys& keys) { keys.of("text"); }),
            "mark: text: is missing");
  EXPECT_EQ(complaint(R"({"do":"mark","text":""})", [](const Keys& keys) { keys.text("text"); }),
            "mark: text: \"\" is not allowed; allowed: a text of 1 to 4000 characters");
  EXPECT_EQ(complaint(R"({"do":"mark","text":null})",
                      [](const Keys& keys) { EXPECT_EQ(keys.text_if("text"), std::nullopt); }),
            "none");
  EXPECT_EQ(complaint(R"({"do":"follow","rate":"x"})",
                      [](const Keys& keys) { keys.number_or("rate", 1, 0.5, 10); }),
            "follow: rate: \"x\" is not allowed; allowed: 0.5 to 10");
  for (const char* end : {"0.5", "10"}) {
    EXPECT_EQ(complaint(std::string(R"({"do":"follow","rate":)") + end + "}",
                        [&](const Keys& keys) {
                          EXPECT_EQ(keys.number_or("rate", 1, 0.5, 10), std::stod(end));
                        }),
              "none");
  }
  EXPECT_EQ(
      complaint(R"({"do":"blind","on":1})", [](const Keys& keys) { keys.flag_or("on", true); }),
      "blind: on: 1 is not allowed; allowed: true, false");
  EXPECT_EQ(complaint(R"({"do":"blind","on":false})",
                      [](const Keys& keys) { EXPECT_FALSE(keys.flag_or("on", true)); }),
            "none");
  for (const char* wrong : {R"("a")", R"(["a",1])", R"([""])", R"(["a","b","c"])"}) {
    EXPECT_EQ(
        complaint(std::string(R"({"do":"get","keys":)") + wrong + "}",
                  [](const Keys& keys) { keys.texts_if("keys", 2); }),
        std::string("get: keys: ") + wrong + " is not allowed; allowed: a list of at most 2 texts");
  }
}

TEST(Keys, NameFilesByWholePathsAndEndings) {
  const test::TempDir dir;
  const auto taken = [](const std::string& file, bool replace) {
    const json request{{"do", "picture"}, {"file", file}, {"replace", replace}};
    return complaint(request.dump(),
                     [&](const Keys& keys) { EXPECT_EQ(keys.file_to_write(".png"), file); });
  };
  const std::string there = dir / "there.png", link = dir / "link.png";
  std::ofstream(there) << "x";
  std::filesystem::create_symlink(dir / "nowhere", link);
  EXPECT_EQ(taken(dir / "new.png", false), "none");
  EXPECT_EQ(taken(there, true), "none");
  for (const std::string& file : {there, link}) {
    EXPECT_THAT(taken(file, false), testing::StartsWith("picture: file: \""));
    EXPECT_THAT(taken(file, false),
                testing::EndsWith("exists already; allowed: a new file, or \"replace\": true"));
  }
  for (const char* wrong : {"new.png", "/new.jpg", "/new"}) {
    EXPECT_EQ(taken(wrong, false),
              std::string("picture: file: \"") + wrong +
                  "\" is not allowed; allowed: a path that begins with / and ends in .png");
  }
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
