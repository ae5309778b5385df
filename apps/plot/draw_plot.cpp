#include "draw_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cairo_handles.hpp"
#include "picture_palette.hpp"
#include "picture_text.hpp"

namespace carom::app {
namespace {

constexpr double kTitle = 56;  // above all panels

std::size_t columns_of(std::size_t panels) {
    return panels > 1 ? 2 : 1;
}

/// The range of all values, a little wider; never empty.
void set_range(const PlotPanel& panel, PanelLayout& layout) {
    constexpr double kHuge = std::numeric_limits<double>::max();
    layout.low = {kHuge, panel.from_zero ? 0 : kHuge};
    layout.high = {-kHuge, panel.from_zero ? 0 : -kHuge};
    for (const Curve& curve : panel.curves) {
        for (const Vec2& point : curve.points) {
            layout.low = layout.low.cwiseMin(point);
            layout.high = layout.high.cwiseMax(point);
        }
    }
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
        double& low = layout.low[axis];
        double& high = layout.high[axis];
        if (!(low <= high)) low = 0, high = 1;
        // A constant is a line in the middle, and rounding is not blown up to fill the panel.
        const double least = std::max(1e-6 * std::max(std::abs(low), std::abs(high)), 1e-300);
        if (high - low < least) low -= least, high += least;
        const double margin = axis == 1 ? 0.08 * (high - low) : 0;
        if (!(panel.from_zero && low == 0)) low -= margin;
        high += margin;
    }
}

void draw_axes(cairo_t* context, const PlotPanel& panel, const PanelLayout& layout) {
    set_colour(context, palette::kGround);
    cairo_rectangle(context, layout.left, layout.top, layout.right - layout.left, layout.bottom - layout.top);
    cairo_fill_preserve(context);
    set_colour(context, palette::kFrame, 0.5);
    cairo_set_line_width(context, 1);
    cairo_stroke(context);
    select_font(context, 12);
    const Ticks along_x = nice_ticks(layout.low.x(), layout.high.x(), 6);
    for (const double value : along_x.values) {
        const double x = layout.to_pixel({value, layout.low.y()}).x();
        draw_tick(context, {x, layout.bottom}, {x, layout.bottom + 5}, 1);
        draw_text(context, tick_label(value, along_x.step), x, layout.bottom + 19, Align::kCentre);
    }
    const Ticks along_y = nice_ticks(layout.low.y(), layout.high.y(), 5);
    for (const double value : along_y.values) {
        const double y = layout.to_pixel({layout.low.x(), value}).y();
        draw_tick(context, {layout.left - 5, y}, {layout.left, y}, 1);
        draw_text(context, tick_label(value, along_y.step), layout.left - 9, y + 4, Align::kRight);
    }
    draw_text(context, printable(panel.x_label), layout.right, layout.bottom + 36, Align::kRight);
    set_colour(context, palette::kText);
    select_font(context, 14, true);
    draw_text(context, shortened(context, printable(panel.y_label), layout.right - layout.left), layout.left,
              layout.top - 9, Align::kLeft);
}

void draw_bars(cairo_t* context, const Curve& curve, const PanelLayout& layout) {
    const double half =
        curve.points.size() > 1 ? (curve.points[1].x() - curve.points[0].x()) / 2 : layout.high.x() / 2;
    for (const Vec2& point : curve.points) {
        const Vec2 low = layout.to_pixel({point.x() - half, 0});
        const Vec2 high = layout.to_pixel({point.x() + half, point.y()});
        cairo_rectangle(context, low.x(), high.y(), high.x() - low.x() - 1, low.y() - high.y());
    }
    cairo_fill(context);
}

void draw_curve(cairo_t* context, const Curve& curve, const PanelLayout& layout) {
    cairo_new_path(context);
    for (const Vec2& point : curve.points) {
        const Vec2 pixel = layout.to_pixel(point);
        cairo_line_to(context, pixel.x(), pixel.y());
    }
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(context, curve.is_theory ? 1.2 : 1.8);
    cairo_stroke(context);
    if (curve.points.size() != 1) return;
    const Vec2 pixel = layout.to_pixel(curve.points[0]);
    cairo_arc(context, pixel.x(), pixel.y(), 3, 0, 7);
    cairo_fill(context);
}

void draw_panel(cairo_t* context, const PlotPanel& panel, const PanelLayout& layout) {
    draw_axes(context, panel, layout);
    std::size_t measured = 0;
    double label_line = layout.top + 18;
    for (const Curve& curve : panel.curves) {
        cairo_save(context);
        cairo_rectangle(context, layout.left, layout.top, layout.right - layout.left,
                        layout.bottom - layout.top);
        cairo_clip(context);
        set_colour(context, curve.is_theory ? palette::kText : curve_colour(measured));
        if (curve.is_bars)
            draw_bars(context, curve, layout);
        else
            draw_curve(context, curve, layout);
        if (!curve.label.empty()) {
            select_font(context, 12);
            draw_text(context, printable(curve.label), layout.right - 10, label_line, Align::kRight);
            label_line += 17;
        }
        cairo_restore(context);
        if (!curve.is_theory) ++measured;
    }
}

void draw_plot(cairo_t* context, const Plot& plot, PictureSize size) {
    set_colour(context, palette::kPage);
    cairo_paint(context);
    set_colour(context, palette::kText);
    select_font(context, 20, true);
    draw_text(context, shortened(context, printable(plot.title), size.width - 40), 20, 34, Align::kLeft);
    for (std::size_t i = 0; i < plot.panels.size(); ++i)
        draw_panel(context, plot.panels[i], panel_layout(plot, i, size));
}

}  // namespace

PictureSize default_plot_size(std::size_t panels) {
    const std::size_t columns = columns_of(panels);
    const std::size_t rows = (panels + columns - 1) / columns;
    return {int(std::min<std::size_t>(560 * columns, std::size_t(kLargestSide))),
            int(std::min<std::size_t>(std::size_t(kTitle) + 300 * rows, std::size_t(kLargestSide)))};
}

PanelLayout panel_layout(const Plot& plot, std::size_t panel, PictureSize size) {
    const std::size_t columns = columns_of(plot.panels.size());
    const std::size_t rows = (plot.panels.size() + columns - 1) / columns;
    const double width = size.width / double(columns);
    const double height = (size.height - kTitle) / double(rows);
    const double left = width * double(panel % columns);
    const std::size_t row = panel / columns;
    const double top = kTitle + height * double(row);
    PanelLayout layout{left + 72, left + width - 22, top + 26, top + height - 50, {}, {}};
    set_range(plot.panels[panel], layout);
    return layout;
}

Colour curve_colour(std::size_t curve) {
    constexpr double kPlaces[] = {0.62, 0.95, 0.35, 0.8, 0.15};
    return map_colour(kPlaces[curve % std::size(kPlaces)]);
}

std::string render_plot(const Plot& plot, PictureFormat format, const std::optional<PictureSize>& size) {
    const PictureSize all = size ? *size : default_plot_size(plot.panels.size());
    return render_with_cairo(format, all, [&](cairo_t* context) { draw_plot(context, plot, all); });
}

}  // namespace carom::app
