-- Towed along x; at the start it may swing aside once and back, so that its wake need not stay symmetric.
local p = params

function place(t)
    local aside = t < p.swing_time and p.swing*(1 - math.cos(2*math.pi*t/p.swing_time))/2 or 0
    return p.speed*t, aside, 0
end
