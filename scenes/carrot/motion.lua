-- One knife, several cuts: params.cuts has their places along x (m). Each takes params.period (s): 0.7 of
-- it down by params.depth (m) and up again, the rest along to the next place, at full height.

function place(t)
    local cuts, period = params.cuts, params.period
    local number = math.floor(t/period) + 1
    if number > #cuts then return cuts[#cuts], 0, 0 end
    local share = t/period - (number - 1)
    if share < 0.7 then return cuts[number], 0, -params.depth*math.sin(math.pi*share/0.7)^2 end
    local from, to = cuts[number], cuts[number + 1] or cuts[number]
    local s = (share - 0.7)/0.3
    return from + (to - from)*s*s*(3 - 2*s), 0, 0
end
