-- A body that goes straight from point to point: params.path has rows { t, x, y, z }, time (s) and shift
-- (m) from where the scene puts it. Before the first row and after the last it stands.

function place(t)
    local path = params.path
    local from = path[1]
    for i = 2, #path do
        local to = path[i]
        if t < to[1] then
            local share = math.max(0, (t - from[1])/(to[1] - from[1]))
            return from[2] + share*(to[2] - from[2]), from[3] + share*(to[3] - from[3]),
                   from[4] + share*(to[4] - from[4])
        end
        from = to
    end
    return from[2], from[3], from[4]
end
