-- Down with a constant force; its length stays along y.
function control(t, body)
    return { force = { 0, 0, -params.force }, hold = "y,turn" }
end
