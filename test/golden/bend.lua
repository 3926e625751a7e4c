-- A beam along x whose free end swings along z.
function deform(x, y, z, t)
    local s = (x - 0.06)/0.06
    return x, y, z + 0.01*s*s*math.sin(params.rate*t)
end
