#include "campaigns/base/published_figures.h"

#include "campaigns/base/decoder.h"

namespace fatmc {

Result<std::vector<PublishedFigure>> decode_published(const CampaignSpec& spec) {
  std::vector<PublishedFigure> figures;
  const Tree* tree = spec.tree.find("published");
  if (tree == nullptr) return figures;
  Decoder top(*tree, "");
  top.choice("kind", {"published"});
  for (const Tree* entry : top.tables("figure")) {
    Decoder table(*entry, "figure");
    PublishedFigure figure;
    figure.table = table.text("table");
    figure.row = table.text("row");
    figure.quantity = table.text("quantity");
    figure.unit = table.text("unit");
    figure.value = table.real("value");
    figure.upper_bound = table.boolean("bound", false);
    figure.source = table.text("source");
    top.take(table.finish());
    figures.push_back(std::move(figure));
  }
  if (Status status = top.finish(); !status) return fail(status.error());
  return figures;
}

const PublishedFigure* find_published(const std::vector<PublishedFigure>& figures, const std::string& table,
                                      const std::string& row, const std::string& quantity) {
  for (const PublishedFigure& figure : figures) {
    if (figure.table == table && figure.row == row && figure.quantity == quantity) return &figure;
  }
  return nullptr;
}

bool compared_with_print(const CampaignSpec& spec, std::uint32_t cell) {
  const Tree* compare = spec.cells.at(cell).tree.find("compare");
  return compare == nullptr || compare->value != decltype(compare->value)(false);
}

}  // namespace fatmc
