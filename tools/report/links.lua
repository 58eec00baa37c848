-- Links of one Markdown file to another, where all are one page: to the other's title, or the
-- heading that is named. What is not in the page keeps its words alone.
local titles = {
  front = "photon-mapping-the-report",
  counterparts = "what-three-texts-show-and-what-stands-here-for-it",
  report = "why-it-is-right-six-proofs",
  default = "which-transport-is-the-default-and-why",
  results = "results",
  discussion = "discussion",
  gallery = "gallery",
  journal = "journal",
}

function Link(link)
  local stem, heading = link.target:match("([%w_-]+)%.md#?(.*)$")
  if stem and titles[stem] then
    link.target = "#" .. (heading ~= "" and heading or titles[stem])
    return link
  end
  if link.target:match("^https?:") or link.target:match("^#") then
    return link
  end
  return link.content
end
