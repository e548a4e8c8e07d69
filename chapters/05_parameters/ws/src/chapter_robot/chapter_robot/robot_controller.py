import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from geometry_msgs.msg import Twist
from std_msgs.msg import String


class RobotController(Node):
    def __init__(self):
        super().__init__('robot_controller')
        self.cmd_vel_pub = self.create_publisher(Twist, 'cmd_vel', 10)
        self.scan_sub = self.create_subscription(
            LaserScan, 'scan', self.scan_callback, 10)
        self.status_sub = self.create_subscription(
            String, 'status', self.status_callback, 10)
        self.timer = self.create_timer(0.1, self.control_loop)
        self.obstacle_detected = False
        self.get_logger().info('Robot controller initialized')

    def scan_callback(self, msg):
        """Process laser scan data"""
        try:
            min_distance = min(msg.ranges) if msg.ranges else float('inf')
            self.obstacle_detected = min_distance < 1.0  # Threshold at 1 meter
            if self.obstacle_detected:
                self.get_logger().warn(f'Obstacle detected at {min_distance:.2f}m')
        except Exception as e:
            self.get_logger().error(f'Error processing scan: {e}')

    def status_callback(self, msg):
        """Handle status messages"""
        self.get_logger().info(f'Status: {msg.data}')

    def control_loop(self):
        """Main control loop"""
        try:
            cmd_vel = Twist()
            if self.obstacle_detected:
                cmd_vel.angular.z = 0.5  # Turn to avoid obstacle
            else:
                cmd_vel.linear.x = 0.3  # Move forward
            self.cmd_vel_pub.publish(cmd_vel)
        except Exception as e:
            self.get_logger().error(f'Error in control loop: {e}')


def main(args=None):
    rclpy.init(args=args)
    node = RobotController()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info('Shutting down robot controller')
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
